// Traces of version 1, kept in the tree: later versions go on reading them, and see the same in them.
//
// ROPSIM_UPDATE_GOLDEN=1 writes their texts and the picture again (the traces themselves only where there are none).
#include "pipeline/reference.hpp"
#include "reports/comparison.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program_run.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/trace_files.hpp"
#include "traces/hash.hpp"
#include "traces/trace_text.hpp"

#include <cstdlib>
#include <gtest/gtest.h>

namespace {

bool to_be_updated() { return std::getenv("ROPSIM_UPDATE_GOLDEN") != nullptr; }

std::filesystem::path golden_file(const std::string& name) { return ropsim_test::source_dir() / "tests/golden" / name; }

std::string text_of_trace(const std::filesystem::path& file) {
    std::string text;
    for (const traces::TraceLine& line : traces::dump_trace(file)) text += line.text() + "\n";
    return text;
}

TEST(TraceGolden, Version1RecordedIsReadAsEver) {
    const auto file = golden_file("version_1_recorded.rtrace"), kept = golden_file("version_1_recorded.txt");
    if (to_be_updated() && !std::filesystem::exists(file))
        traces::write_trace(support::recorded_trace(support::rich_recording()), file);
    const std::string text = text_of_trace(file);
    if (to_be_updated()) ropsim_test::write_text(kept, text);
    EXPECT_EQ(text, ropsim_test::file_text(kept));
    EXPECT_EQ(traces::trace_faults(file), std::vector<std::string>());
}

TEST(TraceGolden, Version1IsReadAsEver) {
    const auto file = golden_file("version_1.rtrace"), kept = golden_file("version_1.txt");
    if (to_be_updated() && !std::filesystem::exists(file)) traces::write_trace(support::rich_trace(), file);
    std::string text = text_of_trace(file);
    reports::ComparisonRequest request;
    request.scene = file.string();
    request.replay = true;
    request.designs = {"existing", "blender"};
    const reports::Comparison replay = reports::compare(reports::prepare(request));
    traces::ContentHash picture;
    picture.add_values(std::span<const float>(replay.reference.composite));
    text += "picture: " + picture.hex() + "\n";
    text += "fragments: " + std::to_string(replay.runs.front().fragments) + "\n";
    if (to_be_updated()) ropsim_test::write_text(kept, text);
    EXPECT_EQ(text, ropsim_test::file_text(kept));
    EXPECT_TRUE(traces::trace_faults(file).empty());
    EXPECT_EQ(replay.runs.back().wrong_pixels, 0U);
}

} // namespace
