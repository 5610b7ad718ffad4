// A trace of version 1, kept in the tree: later versions go on reading it, and see the same in it.
//
// ROPSIM_UPDATE_GOLDEN=1 writes its text and picture again (the trace itself only where there is none).
#include "pipeline/reference.hpp"
#include "reports/comparison.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program_run.hpp"
#include "tests/support/trace_files.hpp"
#include "traces/hash.hpp"
#include "traces/trace_text.hpp"

#include <cstdlib>
#include <gtest/gtest.h>

namespace {

TEST(TraceGolden, Version1IsReadAsEver) {
    const auto file = ropsim_test::source_dir() / "tests/golden/version_1.rtrace";
    const auto kept = ropsim_test::source_dir() / "tests/golden/version_1.txt";
    const bool update = std::getenv("ROPSIM_UPDATE_GOLDEN") != nullptr;
    if (update && !std::filesystem::exists(file)) traces::write_trace(support::rich_trace(), file);
    std::string text;
    for (const traces::TraceLine& line : traces::dump_trace(file)) text += line.text() + "\n";
    reports::ComparisonRequest request;
    request.scene = file.string();
    request.replay = true;
    request.designs = {"existing", "blender"};
    const reports::Comparison replay = reports::compare(reports::prepare(request));
    traces::ContentHash picture;
    picture.add_values(std::span<const float>(replay.reference.composite));
    text += "picture: " + picture.hex() + "\n";
    text += "fragments: " + std::to_string(replay.runs.front().fragments) + "\n";
    if (update) ropsim_test::write_text(kept, text);
    EXPECT_EQ(text, ropsim_test::file_text(kept));
    EXPECT_TRUE(traces::trace_faults(file).empty());
    EXPECT_EQ(replay.runs.back().wrong_pixels, 0U);
}

} // namespace
