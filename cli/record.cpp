// ropsim record and ropsim import: frames of a program that draws with OpenGL, or of an apitrace file.
#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/interruption.hpp"
#include "reports/result.hpp"
#include "reports/trace_info.hpp"
#include "sim/unfinished_file.hpp"
#include "traces/hash.hpp"
#include "traces/recording/record_program.hpp"

#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

namespace cli {

namespace {

std::string hash_of(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    std::vector<char> part(std::size_t{1} << 20U);
    traces::ContentHash hash;
    while (stream.read(part.data(), static_cast<std::streamsize>(part.size())) || stream.gcount() > 0)
        hash.add_values(std::span<const char>(part.data(), static_cast<std::size_t>(stream.gcount())));
    return hash.hex();
}

traces::RecordRequest request_of(const char* command, const RecordingOptions& options) {
    traces::RecordRequest request;
    request.isotropic = options.isotropic;
    if (options.frames.empty()) return request;
    const auto frames = range_of(fmt::format("{}: --frames", command), options.frames);
    if (frames.end <= frames.first)
        throw UsageError(fmt::format("{}: --frames: expected at least one frame, got '{}'", command, options.frames));
    request.first = frames.first;
    request.end = frames.end;
    return request;
}

void write_recording(const RecordingOptions& options, traces::RecordedProgramRun run, const std::string& source,
                     const std::string& hash) {
    traces::Trace trace;
    trace.metadata.writer = fmt::format("ropsim {}", reports::version_text());
    trace.metadata.name = options.name.empty() ? source : options.name;
    trace.metadata.licence = options.licence;
    trace.metadata.scene = source;
    trace.metadata.scene_hash = hash;
    std::vector<std::string> notes{fmt::format("drawn by OpenGL {}", run.context)};
    for (const traces::NotRecorded& one : run.recording.not_recorded)
        notes.push_back(fmt::format("not recorded: {}, {} times", one.call, one.times));
    if (!options.frames.empty() && !run.ended.empty())
        notes.push_back(fmt::format("frames {} were asked for; the program ended {} behind frame {}", options.frames,
                                    run.ended, run.recording.frames.back().number));
    trace.recording = std::move(run.recording);
    traces::write_trace(trace, options.file);
    const auto info = reports::trace_info(options.file);
    print_result(options.json, reports::result_text(info), reports::trace_summary(info), notes);
}

} // namespace

void record(const RecordCommand& command) {
    traces::RecordRequest request = request_of("record", command);
    request.command = command.program;
    sim::check_writable(command.file); // told before a game was played for nothing
    write_recording(command, traces::record_program(request, stop_requested()),
                    std::filesystem::path(command.program.at(0)).filename().string(), "");
}

void import_frames(const ImportCommand& command) {
    const traces::RecordRequest request = request_of("import", command);
    sim::check_writable(command.file);
    write_recording(command, traces::record_apitrace(command.trace, request, stop_requested()),
                    std::filesystem::path(command.trace).filename().string(), hash_of(command.trace));
}

} // namespace cli
