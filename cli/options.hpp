// What the user typed, parsed but not yet checked against what there is.
#pragma once

#include "reports/comparison.hpp"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace cli {

/// What to draw on what; common to several subcommands. Empty texts stand for the default.
struct FrameOptions {
    std::string scene;
    std::string gpu = "neutral";
    std::string workload = "transparency";
    std::string k;
    std::string entry;
    std::string size = "512x512";
    std::string camera = "auto";
    std::string seed = "1";
    std::string threads;
    std::vector<std::string> settings; ///< of --set
};

struct OutputOptions {
    std::string directory; ///< of --out; empty: no files
    bool json = false;
    bool no_images = false;
    bool timeline = false; ///< of ropsim run
};

struct CompareCommand {
    FrameOptions frame;
    OutputOptions output;
    std::string designs = "existing,scoreboard,blender,multipass"; ///< or "all"
};

struct RunCommand {
    FrameOptions frame;
    OutputOptions output;
    std::string design = "existing";
};

struct DescribeCommand {
    std::string topic;
    bool json = false;
    bool names = false; ///< nothing but the names, one a line
};

/// A text asked for with --help or --version.
struct ShowText {
    std::string text;
};

using Command = std::variant<CompareCommand, RunCommand, DescribeCommand, ShowText>;

/// The request that the options stand for. Throws sim::InputError when a number or size is none.
reports::ComparisonRequest request_of(const FrameOptions& options, const std::string& designs);

} // namespace cli
