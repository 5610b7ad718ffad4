// ropsim trace: what a draw trace holds, whether it is whole, where two differ; a part of one.
#include "traces/trace.hpp"
#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "reports/result.hpp"
#include "reports/trace_info.hpp"
#include "sim/check.hpp"
#include "sim/suggest.hpp"
#include "traces/recording/cut.hpp"
#include "traces/trace_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace cli {

namespace {

/// Lines as they are, or as a list of a document.
void print_lines(bool json, const char* key, const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    nlohmann::ordered_json document;
    document[key] = lines;
    print_result(json, reports::result_text(document), text, {});
}

int info(const TraceCommand& command) {
    const auto facts = reports::trace_info(command.file);
    print_result(command.json, reports::result_text(facts), reports::trace_info_text(facts, terminal_style()), {});
    return status_good;
}

int dump(const TraceCommand& command) {
    std::vector<std::string> lines;
    for (const traces::TraceLine& line : traces::dump_trace(command.file)) lines.push_back(line.text());
    print_lines(command.json, "records", lines);
    return status_good;
}

int validate_trace(const TraceCommand& command) {
    const std::vector<std::string> faults = traces::trace_faults(command.file);
    print_lines(command.json, "faults", faults);
    return faults.empty() ? status_good : status_bad;
}

int diff(const TraceCommand& command) {
    const std::vector<std::string> differences = traces::trace_differences(command.file, command.other);
    print_lines(command.json, "differences", differences);
    return differences.empty() ? status_good : status_bad;
}

std::optional<traces::CutRange> cut_range(const char* option, const std::string& text) {
    return text.empty() ? std::nullopt : std::optional(range_of(fmt::format("trace cut: {}", option), text));
}

int cut(const TraceCommand& command) {
    const traces::Cut what{cut_range("--frames", command.frames), cut_range("--draws", command.draws)};
    if (command.output.empty() || (!what.frames && !what.draws))
        throw UsageError("trace cut: expected --frames or --draws, and --output");
    traces::Trace trace = traces::read_trace(command.file);
    if (!trace.recording)
        throw sim::InputError(fmt::format("{}: expected recorded frames to cut, got a captured one", command.file));
    try {
        trace.recording = traces::cut(*trace.recording, what);
    } catch (const sim::InputError& error) {
        throw sim::InputError(fmt::format("{}: {}", command.file, error.what()));
    }
    traces::write_trace(trace, command.output);
    const auto facts = reports::trace_info(command.output);
    print_result(command.json, reports::result_text(facts), reports::trace_summary(facts), {});
    return status_good;
}

} // namespace

int trace(const TraceCommand& command) {
    const std::vector<std::string> actions{"info", "dump", "validate", "diff", "cut"};
    const bool two = command.action == "diff";
    if (command.action != "cut" && !(command.frames + command.draws + command.output).empty())
        throw UsageError(
            fmt::format("trace {}: expected --frames, --draws and --output with cut only", command.action));
    if (two == command.other.empty() && std::find(actions.begin(), actions.end(), command.action) != actions.end())
        throw UsageError(fmt::format("trace {}: expected {}", command.action, two ? "two traces" : "one trace"));
    if (command.action == "info") return info(command);
    if (command.action == "dump") return dump(command);
    if (command.action == "validate") return validate_trace(command);
    if (two) return diff(command);
    if (command.action == "cut") return cut(command);
    throw UsageError(fmt::format("trace: expected one of {}, got '{}'{}", fmt::join(actions, ", "), command.action,
                                 sim::did_you_mean(command.action, actions)));
}

} // namespace cli
