// Tables for people and for spreadsheets, and the page.
#include "reports/csv.hpp"
#include "reports/flatten.hpp"
#include "reports/hazard_text.hpp"
#include "reports/html/markup.hpp"
#include "reports/html/page.hpp"
#include "reports/numbers.hpp"
#include "reports/terminal_table.hpp"
#include "reports/text_table.hpp"
#include "tests/support/sample_comparison.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>

namespace {

using nlohmann::ordered_json;
using ropsim_test::sample_comparison;

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::string cell(const reports::Table& table, std::size_t row, const std::string& column) {
    for (std::size_t i = 0; i < table.header.size(); ++i)
        if (table.header[i] == column) return table.rows.at(row).at(i);
    return "no column " + column;
}

TEST(ReportsText, Numbers) {
    EXPECT_EQ(reports::with_commas(0), "0");
    EXPECT_EQ(reports::with_commas(999), "999");
    EXPECT_EQ(reports::with_commas(1234567), "1,234,567");
    EXPECT_EQ(reports::short_number(0), "0");
    EXPECT_EQ(reports::short_number(9999), "9999");
    EXPECT_EQ(reports::short_number(12345), "12.3k");
    EXPECT_EQ(reports::short_number(999'600), "1.00M");
    EXPECT_EQ(reports::short_number(0.5), "0.50");
    EXPECT_EQ(reports::bytes_text(512), "512 B");
    EXPECT_EQ(reports::bytes_text(131e6), "131 MB");
    EXPECT_EQ(reports::duration_text(0.345), "0.34 s");
    EXPECT_EQ(reports::duration_text(200), "3 min 20 s");
}

TEST(ReportsText, FlattenNamesLeavesAndShortensHistograms) {
    const ordered_json json = {
        {"a", {{"b", 1}, {"c", "text"}}},
        {"list", {1, 2}},
        {"h",
         {{"count", 1}, {"sum", 4}, {"min", 4}, {"max", 4}, {"mean", 4.0}, {"bin_width", 0}, {"bins", {{"4", 1}}}}}};
    std::vector<std::string> paths;
    for (const auto& [path, value] : reports::flatten(json)) paths.push_back(path + "=" + reports::cell_text(value));
    EXPECT_EQ(paths, (std::vector<std::string>{"a.b=1", "a.c=text", "list.0=1", "list.1=2", "h.count=1", "h.mean=4.0",
                                               "h.min=4", "h.max=4"}));
}

TEST(ReportsText, CsvHasOneRowPerDesignWithAllNumbers) {
    const auto table = reports::designs_table(sample_comparison());
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_EQ(cell(table, 0, "design"), "racy");
    EXPECT_EQ(cell(table, 0, "variant"), "racy?bypass_l1=false");
    EXPECT_EQ(cell(table, 0, "h3 [fragments]"), "1");
    EXPECT_EQ(cell(table, 0, "h3_incoherence [fragments]"), "1");
    EXPECT_EQ(cell(table, 0, "h3_concurrency [fragments]"), "0");
    EXPECT_EQ(cell(table, 0, "concurrency [fragments]"), "1");
    EXPECT_EQ(cell(table, 0, "concurrency per million [1e-6]"), "25000");
    EXPECT_EQ(cell(table, 0, "area.total_bytes"), "69640");
    EXPECT_EQ(cell(table, 1, "time [ms]"), "0.02");
    EXPECT_EQ(cell(table, 0, "layer1.missing"), "2");
    EXPECT_EQ(cell(table, 0, "caches.texture_l1.hit_rate"), "0.8");
    EXPECT_EQ(cell(table, 1, "bytes.dram.bytes"), "5120");
}

TEST(ReportsText, CsvRowsHaveAsManyCellsAsTheHeader) {
    for (const auto& table : reports::all_tables(sample_comparison()))
        for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size()) << table.name;
}

TEST(ReportsText, CsvQuotesWhatNeedsIt) {
    EXPECT_NE(reports::passes_table(sample_comparison()).text().find("\"layers, all\""), std::string::npos);
    EXPECT_NE(reports::draws_table(sample_comparison()).text().find("\"draw \"\"a\"\"\""), std::string::npos);
}

TEST(ReportsText, CsvNamesBothFragmentsOfAHazardAndHowManyThereAre) {
    auto comparison = sample_comparison();
    comparison.runs[0].hazards.at(pipeline::HazardClass::h1_in_flight, pipeline::HazardKind::concurrency) = 50;
    const auto table = reports::hazard_pairs_table(comparison);
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_EQ(cell(table, 0, "kind"), "concurrency");
    EXPECT_EQ(cell(table, 1, "class"), "h3");
    EXPECT_EQ(cell(table, 1, "kind"), "incoherence");
    EXPECT_EQ(cell(table, 1, "victim [quad]"), "9");
    EXPECT_EQ(cell(table, 1, "aggressor [quad]"), "4");
    EXPECT_EQ(cell(table, 1, "read [core cycle]"), "120");
    EXPECT_EQ(cell(table, 1, "listed"), "2");
    EXPECT_EQ(cell(table, 1, "hazards"), "51");
}

TEST(ReportsText, CsvHazardDistanceStatesItsRanges) {
    const auto table = reports::hazard_distance_table(sample_comparison());
    ASSERT_EQ(table.rows.size(), 4U);
    EXPECT_EQ(cell(table, 3, "from [quads]"), "8");
    EXPECT_EQ(cell(table, 3, "below [quads]"), "16");
    EXPECT_EQ(cell(table, 3, "hazards [fragments]"), "1");
}

TEST(ReportsText, TerminalTableFits120ColumnsAtAnyNumbers) {
    auto comparison = sample_comparison();
    comparison.runs[0].design = "sorted-batched";
    for (auto& run : comparison.runs) {
        run.cycles = 123'456'789;
        run.fragments = 98'765'432;
        run.hazards.by = {{{1'234'567, 2'345'678}, {0, 0}, {3'456'789, 4'567'890}, {9'876'543, 1}}};
        run.wrong_pixels = 262'144;
        run.lost_fragments = 1'048'576;
    }
    for (const std::string& line : lines_of(reports::designs_text(comparison, {})))
        EXPECT_LE(line.size(), 120U) << line;
}

TEST(ReportsText, HazardsAreShownByClassAndKind) {
    const std::string text = reports::hazards_text(sample_comparison(), {});
    const auto lines = lines_of(text);
    ASSERT_GE(lines.size(), 4U);
    EXPECT_TRUE(lines[2].starts_with("racy bypass_l1=false  concurrency")) << text;
    EXPECT_NE(lines[3].find("incoherence"), std::string::npos) << text;
    EXPECT_EQ(text.find("safe"), std::string::npos) << "it has none";
    auto none = sample_comparison();
    none.runs[0].hazards = {};
    EXPECT_EQ(reports::hazards_text(none, {}), "");
}

TEST(ReportsText, TerminalTableSaysWhatEachKindBreaksAndWhatProtectionCosts) {
    const auto lines = lines_of(reports::designs_text(sample_comparison(), {}));
    ASSERT_GE(lines.size(), 5U);
    for (const char* title : {"concurrency", "incoherence", "speed", "on chip"})
        EXPECT_NE(lines[0].find(title), std::string::npos) << lines[0];
    EXPECT_NE(lines[3].find("68.0"), std::string::npos) << "KiB on chip: " << lines[3];
    EXPECT_EQ(lines[4], "speed: times that of racy bypass_l1=false");
}

TEST(ReportsText, TerminalTableIsExactWhereItFits) {
    auto comparison = sample_comparison();
    comparison.runs[1].cycles = 1'234'567;
    EXPECT_NE(reports::designs_text(comparison, {}).find("1,234,567"), std::string::npos);
}

TEST(ReportsText, TerminalTableHasColourOnlyWhenAsked) {
    EXPECT_EQ(reports::designs_text(sample_comparison(), {}).find('\033'), std::string::npos);
    EXPECT_NE(reports::designs_text(sample_comparison(), {true, 120}).find("\033[31m"), std::string::npos);
}

TEST(ReportsText, LeftOutIsStatedOnceWithItsReason) {
    auto comparison = sample_comparison();
    comparison.runs[1].left_out.emplace_back("texture_l1", "the blender reads its own tiles");
    const auto lines = lines_of(reports::left_out_text(comparison, {}));
    ASSERT_EQ(lines.size(), 3U);
    EXPECT_EQ(lines[1], "  stencil     no pass tests it");
    EXPECT_EQ(lines[2], "  texture_l1  safe: the blender reads its own tiles");
}

TEST(ReportsText, WrapBreaksBetweenWords) {
    EXPECT_EQ(reports::wrap("aaa bbb ccc", 7, 2), "aaa bbb\n  ccc\n");
    EXPECT_EQ(reports::wrap("  a  b", 80, 2), "  a  b\n");
    EXPECT_EQ(reports::wrap("  aaaaaaaaa b", 7, 2), "  aaaaaaaaa\n  b\n") << "no empty line before a long word";
}

TEST(ReportsText, WrapBreaksLongVariantsBetweenTheirSettings) {
    EXPECT_EQ(reports::wrap("a?b=1&c=2&d=3: x", 10, 2), "a?b=1&\n  c=2&d=3:\n  x\n");
    EXPECT_EQ(reports::wrap("a?b=1&c=2 x", 20, 2), "a?b=1&c=2 x\n") << "where it fits it stays whole";
}

TEST(ReportsText, TablesOfNarrowTerminalsCutWhatIsTooWide) {
    const std::string wide(50, 'w');
    for (const std::string& line : lines_of(reports::text_table({{"one", "", true}, {"two", "", true}, {"three", ""}},
                                                                {{wide, wide, "3"}}, {false, 40})))
        EXPECT_LE(line.size(), 40U) << line;
}

TEST(ReportsText, PageIsSelfContainedAndEscaped) {
    const std::vector<reports::PictureFile> pictures{{"overlap.png", "", "fragments per pixel"},
                                                     {"racy/layer0.png", "racy", "layer 0", true}};
    const std::string page = reports::html_page(sample_comparison(), pictures, {"designs.csv"});
    EXPECT_NE(page.find("two &lt;sheets&gt;.glb"), std::string::npos);
    EXPECT_EQ(page.find("two <sheets>"), std::string::npos);
    EXPECT_NE(page.find("src=\"racy/layer0.png\""), std::string::npos);
    EXPECT_NE(page.find("no pass tests it"), std::string::npos);
    EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org")) << "nothing is loaded from elsewhere";
    EXPECT_EQ(page.find("src=\"http"), std::string::npos);
}

TEST(ReportsText, ScriptDataCannotEndItsElement) {
    EXPECT_EQ(reports::script_json("</script>"), "\"\\u003c/script>\"");
}

} // namespace
