// G8: what interleaved arrays save over separate ones, in lines of the pre-transform cache (Bavoil 2007, section 3.7.2;
// specification 004, section 5: the interleaving model).
#include "tests/support/replay.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace interleaving_test {

using support::counter;
using support::Replay;

/// Bytes of vertices fetched from memory, in lines of 64 bytes, for n sets of four floats beside the position.
double vertex_bytes(const std::string& scene, std::uint32_t n, const char* layout, const char* cache_bytes) {
    const Replay replay(fmt::format("{}&attributes=texcoord:4f32*{}&layout={}", scene, n, layout),
                        {32, 32, "geometry"});
    const auto run = replay.run("existing", {"geometry.vertex_fetch.cache.line=64",
                                             fmt::format("geometry.vertex_fetch.cache.bytes={}", cache_bytes)});
    return static_cast<double>(counter(run.stages, "vertex_fetch/counters/bytes"));
}

double separate_over_interleaved(const std::string& scene, std::uint32_t n, const char* cache_bytes) {
    return vertex_bytes(scene, n, "separate", cache_bytes) / vertex_bytes(scene, n, "interleaved", cache_bytes);
}

TEST(Interleaving, G8ColdRandomOrderSavesWhatTheLinesOfARecordPredict) {
    // A cache far smaller than the data, and no locality: every vertex comes from memory.
    const std::string scene = "gen:blob?triangles=8000&order=random&vertex_order=random";
    double before = 1.0;
    for (std::uint32_t n = 1; n <= 8; ++n) {
        const double ratio = separate_over_interleaved(scene, n, "1024");
        // Separate: 1 + 8/64 lines of 12 bytes and one for each set; together a record of 12 + 16n bytes.
        const double expected = (1.125 + n) / (1.0 + (8.0 + 16.0 * n) / 64.0);
        EXPECT_NEAR(ratio, expected, 0.05 * expected) << n;
        EXPECT_GT(ratio, before) << n;
        before = ratio;
    }
    EXPECT_NEAR(before, 2.92, 0.292);
}

TEST(Interleaving, G8SequentialOrderSavesLittle) {
    for (const std::uint32_t n : {1U, 4U, 8U}) {
        const double ratio = separate_over_interleaved("gen:grass?blades=2000", n, "16384");
        EXPECT_GE(ratio, 0.999) << n; // both fetch each byte once; the last lines of the buffers differ
        EXPECT_LE(ratio, 1.3) << n;
    }
}

} // namespace interleaving_test
