#include "cli/trace_options.hpp"

#include "cli/frame_options.hpp"
#include "cli/help_texts.hpp"

namespace cli {

void add_capture(CLI::App& command, CaptureCommand& options) {
    add_frame(command, options.frame);
    add_settings(command, options.frame.settings, "Sets a parameter of the workload (workload.KEY)");
    command.add_option("-o,--output", options.file, "The file to write (.rtrace)")->required()->type_name("FILE");
    command.add_option("--name", options.name, "What the trace is called (default: the scene)")->type_name("TEXT");
    command.add_option("--licence", options.licence, "Under which its content may be passed on, and whose it is")
        ->type_name("TEXT");
    command.add_flag("--json", options.json, "Print one JSON document on standard output, and nothing else");
    command.footer(capture_help);
}

namespace {

void add_recording(CLI::App& command, RecordingOptions& options, const char* whose) {
    command
        .add_option("--frames", options.frames,
                    std::string("The ") + whose +
                        "'s frames FIRST to END - 1, from 0 (default 0:10, as far as there are)")
        ->type_name("FIRST:END");
    command.add_option("-o,--output", options.file, "The file to write (.rtrace)")->required()->type_name("FILE");
    command.add_flag("--isotropic", options.isotropic,
                     "Samplers take one probe a texel, in the program as well: for comparisons with its own pictures");
    command.add_option("--name", options.name, std::string("What the trace is called (default: the ") + whose + ")")
        ->type_name("TEXT");
    command.add_option("--licence", options.licence, "Under which its content may be passed on, and whose it is")
        ->type_name("TEXT");
    command.add_flag("--json", options.json, "Print one JSON document on standard output, and nothing else");
}

} // namespace

void add_record(CLI::App& command, RecordCommand& options) {
    add_recording(command, options, "program");
    command.add_option("program", options.program, "The program and its arguments, behind --")
        ->required()
        ->type_name("PROGRAM ...");
    command.footer(record_help);
}

void add_import(CLI::App& command, ImportCommand& options) {
    command.add_option("trace", options.trace, "An apitrace file (.trace)")->required()->type_name("TRACE");
    add_recording(command, options, "file");
    command.footer(import_help);
}

void add_replay(CLI::App& command, ReplayCommand& options) {
    command.add_option("trace", options.frame.scene, "A draw trace (.rtrace)")->required()->type_name("TRACE");
    command
        .add_option("--frames", options.frames,
                    "Frames FIRST to END - 1 of a recording, counted from 0, or one (default the last)")
        ->type_name("FIRST:END");
    command
        .add_option(
            "--kbuffer", options.kbuffer,
            "Draws of a recording that go through a k-buffer instead of being blended: blended, draws=FIRST:END, or "
            "pass=N (ropsim trace info numbers them)")
        ->type_name("DRAWS");
    command.add_flag("--cold-caches", options.cold, "Texture and vertex caches are empty when a frame begins");
    command.add_option("--k", options.k, "Entries of that k-buffer, per pixel (default 4)")->type_name("K");
    add_machine(command, options.frame);
    add_settings(command, options.frame.settings, "Overrides a number of the GPU or of a design");
    add_designs(command, options);
    add_output_options(command, options.output);
    command.footer(replay_help);
}

void add_trace(CLI::App& command, TraceCommand& options) {
    command
        .add_option("action", options.action,
                    "info: what it is of, and its chunks; dump: all of it as text, of blobs the hash; validate: every "
                    "fault; diff: where two differ; cut: a smaller one of recorded frames")
        ->required()
        ->type_name("ACTION");
    command.add_option("trace", options.file, "A draw trace (.rtrace)")->required()->type_name("TRACE");
    command.add_option("other", options.other, "diff: the one to compare with")->type_name("TRACE");
    command.add_option("--frames", options.frames, "cut: the application's frames FIRST to END - 1")
        ->type_name("FIRST:END");
    command
        .add_option("--draws", options.draws, "cut: draws of the one frame, from 0, without those before and behind")
        ->type_name("FIRST:END");
    command.add_option("-o,--output", options.output, "cut: the file to write (.rtrace)")->type_name("FILE");
    command.add_flag("--json", options.json, "Print one JSON document on standard output, and nothing else");
    command.footer(trace_help);
}

} // namespace cli
