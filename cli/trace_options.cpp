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

void add_replay(CLI::App& command, ReplayCommand& options) {
    command.add_option("trace", options.frame.scene, "A draw trace (.rtrace)")->required()->type_name("TRACE");
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
                    "fault; diff: where two differ")
        ->required()
        ->type_name("ACTION");
    command.add_option("trace", options.file, "A draw trace (.rtrace)")->required()->type_name("TRACE");
    command.add_option("other", options.other, "diff: the one to compare with")->type_name("TRACE");
    command.add_flag("--json", options.json, "Print one JSON document on standard output, and nothing else");
    command.footer(trace_help);
}

} // namespace cli
