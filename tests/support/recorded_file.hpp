// For tests of recorded frames in files: what writes one, and what it says as text.
#pragma once

#include "tests/support/program_run.hpp"
#include "tests/support/recordings.hpp"
#include "traces/trace_text.hpp"

#include <filesystem>
#include <gtest/gtest.h>
#include <string>

namespace support {

class RecordedFile : public ::testing::Test {
  protected:
    std::filesystem::path write(const traces::Recording& recording, const std::string& name = "x.rtrace") {
        traces::write_trace(recorded_trace(recording), folder_.path() / name);
        return folder_.path() / name;
    }
    std::string dump(const std::filesystem::path& file) {
        std::string text;
        for (const traces::TraceLine& line : traces::dump_trace(file)) text += line.text() + "\n";
        return text;
    }
    ropsim_test::TemporaryFolder folder_;
};

} // namespace support
