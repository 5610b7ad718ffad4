// What is recorded of apitrace files, beside what Mesa counted when it drew them.
#include "sim/check.hpp"
#include "tests/support/paths.hpp"
#include "traces/glsl.hpp"
#include "traces/recording/record_program.hpp"
#include "traces/recording/recording_check.hpp"

#include <atomic>
#include <gtest/gtest.h>

namespace imported_traces_test {

namespace {

struct Counts {
    std::uint64_t draws = 0, vertices = 0, primitives = 0;
    bool operator==(const Counts&) const = default;
};

void PrintTo(const Counts& counts, std::ostream* stream) {
    *stream << counts.draws << " draws, " << counts.vertices << " vertices, " << counts.primitives << " primitives";
}

Counts counts_of(const traces::Recording& recording, const traces::RecordedFrame& frame) {
    Counts counts;
    for (const traces::RecordedCommand& command : frame.commands)
        if (const auto* draw = std::get_if<traces::RecordedDraw>(&command)) {
            const pipeline::Geometry& geometry = recording.resources->geometries.at(draw->geometry);
            ++counts.draws;
            counts.vertices += std::uint64_t{geometry.index_count} * draw->instances;
            counts.primitives += std::uint64_t{geometry.primitive_count()} * draw->instances;
        }
    return counts;
}

/// Of each frame; nothing where the test is to be skipped, with the reason.
std::optional<std::vector<Counts>> imported_counts(const char* name, std::string& reason) {
    const auto file = ropsim_test::shared_file(std::filesystem::path("traces") / name);
    if (!file) reason = std::string(name) + " is not there";
    if (!traces::can_compile_glsl()) reason = "built without glslang (packages glslang-dev and spirv-tools)";
    if (!reason.empty()) return std::nullopt;
    const std::atomic<bool> stop{false};
    try {
        const traces::Recording recording = traces::record_apitrace(*file, {}, stop).recording;
        traces::check_recording(recording, name);
        EXPECT_EQ(traces::module_faults(recording, name), std::vector<std::string>{});
        EXPECT_EQ(recording.not_recorded, std::vector<traces::NotRecorded>{});
        std::vector<Counts> counts;
        for (const traces::RecordedFrame& frame : recording.frames) counts.push_back(counts_of(recording, frame));
        return counts;
    } catch (const sim::InputError& error) {
        if (std::string(error.what()).find("which was not found: Debian package") == std::string::npos) throw;
        reason = error.what();
        return std::nullopt;
    }
}

} // namespace

TEST(ImportedTraces, BunnyHasMesasCounts) {
    std::string reason;
    const auto counts = imported_counts("bunny_glmark2_3frames.trace", reason);
    if (!counts) GTEST_SKIP() << reason;
    EXPECT_EQ(*counts, (std::vector<Counts>{{1, 21516, 7172}, {1, 21516, 7172}, {1, 21516, 7172}}));
}

TEST(ImportedTraces, IdeasHasMesasCounts) {
    std::string reason;
    const auto counts = imported_counts("ideas_glmark2_2frames.trace", reason);
    if (!counts) GTEST_SKIP() << reason;
    EXPECT_EQ(*counts, (std::vector<Counts>{{180, 3370, 3010}, {180, 3370, 3010}}));
}

} // namespace imported_traces_test
