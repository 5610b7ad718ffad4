// C1, H18 and N5: what is checked on a stream, on many orders and on the files of a report.
#include "pipeline/memory/cache.hpp"
#include "reports/csv.hpp"
#include "reports/html/page.hpp"
#include "reports/result.hpp"
#include "tests/physics/runs.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace physics {
namespace {

// ---- C1

/// Hits of `passes` over `lines` lines, each accessed `times` in a row.
double hit_rate(std::uint32_t lines, std::uint32_t passes, std::uint32_t times) {
    pipeline::Cache cache({.bytes = 4096, .line = 64, .ways = 4}, "cache"); // 64 lines
    for (std::uint32_t pass = 0; pass < passes; ++pass)
        for (std::uint32_t line = 0; line < lines; ++line)
            for (std::uint32_t time = 0; time < times; ++time) cache.access(line);
    return static_cast<double>(cache.stats().hits) / static_cast<double>(cache.stats().accesses());
}

TEST(PhysicsStreams, PHY_C1_LeastRecentlyUsed) {
    constexpr std::uint32_t lines = 64, sets = 16;
    EXPECT_EQ(hit_rate(lines, 34, 1), 33.0 / 34.0); // 97 %: 64 cold misses
    EXPECT_EQ(hit_rate(lines + sets, 34, 1), 0.0);  // a line too many in every set
    EXPECT_EQ(hit_rate(lines + sets, 34, 4), 0.75); // and three accesses to a line just brought in
}

// ---- H18

double insertions(std::uint32_t k, std::uint32_t seed) {
    constexpr double pixels = 4;
    return numbers_of({.name = "r",
                       .scene = fmt::format("gen:stack?n=16&order=random&seed={}", seed),
                       .workload = "transparency",
                       .gpu = "neutral",
                       .design = "blender",
                       .width = 16,
                       .height = 16,
                       .workload_settings = {fmt::format("k={}", k), "entry=z"},
                       .settings = {}})
               ->at("stages.rop.counters.insertions") /
           pixels;
}

TEST(PhysicsOrders, PHY_H18_InsertionsOfRandomOrders) {
    constexpr std::uint32_t layers = 16, orders = 40;
    for (const std::uint32_t k : {4U, 8U}) {
        double expected = k, variance = 0, sum = 0;
        for (std::uint32_t i = k + 1; i <= layers; ++i) {
            const double chance = static_cast<double>(k) / i;
            expected += chance;
            variance += chance * (1 - chance);
        }
        for (std::uint32_t seed = 1; seed <= orders; ++seed) sum += insertions(k, seed);
        EXPECT_NEAR(sum / orders, expected, 3 * std::sqrt(variance / orders)) << "k = " << k;
        EXPECT_NEAR(expected, k == 4 ? 9.19 : 13.30, 0.005);
    }
}

// ---- N5

reports::Comparison small_comparison() {
    reports::ComparisonRequest request;
    request.scene = "gen:discs?n=60&overlap=4&width=32&height=32";
    request.width = request.height = 32;
    request.designs = {"existing", "interlock"};
    request.threads = 1;
    return reports::compare(reports::prepare(request));
}

/// The text of a number in result.json, found by its path.
std::string text_in(const nlohmann::ordered_json& design, const std::string& path) {
    const nlohmann::ordered_json::json_pointer pointer(path);
    return design.contains(pointer) ? design.at(pointer).dump() : "";
}

/// 1234567 -> "1,234,567", as tables for people have it.
std::string with_commas(std::string digits) {
    for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
    return digits;
}

TEST(PhysicsReports, PHY_N5_JsonCsvAndPageAgree) {
    const reports::Comparison comparison = small_comparison();
    const auto json = reports::result_json(comparison);
    const std::string page = reports::html_page(comparison, {}, {});
    const reports::Table table = reports::designs_table(comparison);
    ASSERT_EQ(table.rows.size(), 2U);
    for (std::size_t design = 0; design < table.rows.size(); ++design) {
        SCOPED_TRACE(table.rows[design].front());
        const auto& facts = json.at("designs").at(design);
        std::size_t compared = 0;
        for (const auto& [column, path] :
             std::vector<std::pair<std::string, std::string>>{{"cycles", "/cycles"},
                                                              {"fragments", "/fragments"},
                                                              {"hazards", "/hazards/total"},
                                                              {"concurrency", "/hazards/concurrency"},
                                                              {"incoherence", "/hazards/incoherence"},
                                                              {"wrong pixels", "/wrong_pixels"},
                                                              {"lost updates", "/lost_updates"}}) {
            const auto named = [&column = column](const std::string& title) {
                return title.substr(0, title.find(" [")) == column;
            };
            const auto found = std::find_if(table.header.begin(), table.header.end(), named);
            ASSERT_NE(found, table.header.end()) << column;
            const std::string& cell = table.rows[design][static_cast<std::size_t>(found - table.header.begin())];
            EXPECT_EQ(cell, text_in(facts, path)) << column;
            EXPECT_TRUE(page.find(cell) != std::string::npos || page.find(with_commas(cell)) != std::string::npos)
                << column << " " << cell << " is not on the page";
            ++compared;
        }
        EXPECT_EQ(compared, 7U);
    }
}

} // namespace
} // namespace physics
