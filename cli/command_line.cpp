#include "cli/command_line.hpp"

#include "cli/frame_options.hpp"
#include "cli/help_texts.hpp"
#include "cli/trace_options.hpp"
#include "reports/result.hpp"
#include "sim/suggest.hpp"
#include "traces/workloads.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace cli {

namespace {

void add_truth(CLI::App& command, TruthCommand& options) {
    add_scene(command, options.scene);
    add_workload(command, options.workload,
                 fmt::format("Rendering method, one of {}",
                             ids_of([](const traces::Workload& one) { return bool(one.truth); })));
    add_size(command, options.size);
    add_camera(command, options.camera);
    command.add_option("--set", options.settings, "Sets a parameter of the workload (workload.KEY); may be repeated")
        ->type_name("PATH=VALUE")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command.add_option("--layers", options.layers, "Layers whose depths are kept (default 8)")->type_name("N");
    command
        .add_option("--light", options.light,
                    "Also how much of a square light each pixel's surface sees: centre x,y,z and two half edges "
                    "x,y,z each, nine numbers")
        ->type_name("LIGHT");
    command
        .add_option("--rays", options.rays,
                    "Rays to the light from each surface, as near as n x n comes to it (default 1000)")
        ->type_name("N");
    command.add_option("--seed", options.seed, "Seed of the places on the light (default 1)")->type_name("N");
    add_threads(command, options.threads);
    command.add_flag("--check", options.check, "Also rasterize the frame in submission order and compare");
    command.add_option("--out", options.directory, "Folder for truth.json and pictures")->type_name("DIR");
    command.add_flag("--json", options.json, "Print one JSON document on standard output, and nothing else");
    command.add_flag("--no-images", options.no_images, "Write no pictures (OpenImageIO is not loaded)");
    command.add_flag("--no-cache", options.no_cache,
                     "Neither look for an earlier run's rays in ~/.cache/ropsim nor keep these there");
    add_parameters(command, options.parameters);
    command.footer(with_examples(truth_help, "truth"));
}

void add_accuracy(CLI::App& command, AccuracyCommand& options) {
    add_frame_options(command, options.frame);
    command
        .add_option("--design", options.design,
                    "Design that runs the frames, NAME?key=value (default multipass; blender or interlock where the "
                    "one before cannot)")
        ->type_name("NAME");
    command
        .add_option("--sweep", options.sweep,
                    "Values of a parameter of the workload to try; repeated: every combination (default: each knob of "
                    "the workload alone)")
        ->type_name("KNOB=VALUES")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command.add_option("--rays", options.rays, "Rays of the truth to the light from each point (default 1000)")
        ->type_name("N");
    command
        .add_option(
            "--against", options.against,
            "Measure against another setting of the workload, in submission order, instead of ray-traced truth; "
            "workload=NAME among the settings: against another method")
        ->type_name("'KEY=VALUE ...'");
    command
        .add_option("--averaged", options.averaged,
                    fmt::format("Also the mean of 4, 16, 64 ... frames, up to N ({})", averaged_frames()))
        ->type_name("N");
    command
        .add_option("--out", options.output.directory, "Folder for accuracy.json, a table, report.html and pictures")
        ->type_name("DIR");
    command.add_flag("--json", options.output.json, "Print one JSON document on standard output, and nothing else");
    command.add_flag("--no-images", options.output.no_images, "Write no pictures (OpenImageIO is not loaded)");
    command.add_flag("--no-cache", options.no_cache,
                     "Neither look for an earlier run's rays in ~/.cache/ropsim nor keep these there");
    command.footer(with_examples(accuracy_help, "accuracy"));
}

void add_geometry(CLI::App& command, GeometryCommand& options) {
    add_scene(command, options.scene);
    command.add_option("--gpu", options.gpu, "Name of a GPU or a .toml file (default neutral)")->type_name("GPU");
    command
        .add_option(
            "--prepare", options.prepare,
            "Preparation of the meshes, NAME?key=value&key=value; may be repeated (default: all that are usual, "
            "each alone)")
        ->type_name("NAME")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command
        .add_option("--submission", options.submission,
                    "Where vertices come from: buffers, client_arrays, immediate, display_list (default buffers)")
        ->type_name("WAY");
    command.add_option("--reads", options.reads, "Attributes the vertex shader reads: all or position (default all)")
        ->type_name("WHICH");
    command.add_option("--fidelity", options.fidelity, "estimate or detailed (default detailed)")->type_name("NAME");
    command.add_option("--seed", options.seed, "Seed of everything random in the hardware (default 1)")->type_name("N");
    command.add_option("--set", options.settings, "Overrides a number of the GPU; may be repeated")
        ->type_name("PATH=VALUE")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command.add_option("--export", options.export_to, "Write the prepared scene to this .glb file; needs --prepare")
        ->type_name("FILE");
    command.add_option("--out", options.directory, "Folder for geometry.json and tables")->type_name("DIR");
    command.add_flag("--json", options.json, "Print one JSON document on standard output, and nothing else");
    command.footer(geometry_help);
}

void add_sensitivity(CLI::App& command, SensitivityCommand& options) {
    add_frame_options(command, options.frame);
    command
        .add_option("--designs", options.designs, "Designs to run, as of ropsim compare (default: those of compare)")
        ->type_name("NAMES");
    command
        .add_option("--parameters", options.parameters,
                    "Parameters to vary, or sections of them, separated by commas (default: all whose origin is "
                    "assumed and that a unit of the runs reads)")
        ->type_name("PATHS");
    command.add_option("--factor", options.factor, "Numbers are divided and multiplied by it (default 2)")
        ->type_name("N");
    command.add_option("--out", options.directory, "Folder for sensitivity.json, tables and a page with the charts")
        ->type_name("DIR");
    command.add_flag("--json", options.json, "Print one JSON document on standard output, and nothing else");
    command.footer(sensitivity_help);
}

void add_stability(CLI::App& command, StabilityCommand& options) {
    command.add_option("--filter", options.filter, "Ids of cases with * and ?, by commas (all)")->type_name("IDS");
    command.add_option("--out", options.directory, "Folder for stability.json, tables and a page")->type_name("DIR");
    command.add_flag("--json", options.json, "Print one JSON document on standard output, and nothing else");
    command.add_flag("--no-images", options.no_images, "Write no pictures (OpenImageIO is not loaded)");
    command.footer(stability_help);
}

constexpr const char* usual_fidelity = "estimate or detailed (default detailed)";

void add_measure(CLI::App& command, MeasureCommand& options, const char* footer,
                 const char* fidelity = usual_fidelity) {
    command.add_option("--gpus", options.gpus, "GPUs, separated by commas (default: all that were measured)")
        ->type_name("NAMES");
    command.add_option("--fidelity", options.fidelity, fidelity)->type_name("NAME");
    add_threads(command, options.threads);
    command.add_flag("--json", options.json, "Print one JSON document on standard output, and nothing else");
    command.footer(footer);
}

struct Parser {
    Parser() {
        app.description("ropsim: a cycle-approximate simulator of a GPU's graphics pipeline and of k-buffer hardware.");
        app.name("ropsim");
        app.footer(general_help);
        app.set_help_flag("-h,--help", "Print help and end");
        app.add_flag("--version", version, "Print version and build and end");
        app.require_subcommand(0, 1);
        app.get_formatter()->column_width(34);

        CLI::App* command = app.add_subcommand("compare", "Run several k-buffer designs on one frame");
        add_frame_options(*command, compare.frame);
        add_designs(*command, compare);
        add_output_options(*command, compare.output);
        command->footer(compare_help);

        command = app.add_subcommand("run", "Run one design and print every counter");
        add_frame_options(*command, run.frame);
        command->add_option("--design", run.design, "Design to run, NAME?key=value&key=value (default existing)")
            ->type_name("NAME");
        add_output_options(*command, run.output);
        command
            ->add_flag("--timeline", run.output.timeline,
                       "Also write timeline.json: what every unit did when, for Perfetto or chrome://tracing")
            ->needs("--out");
        command->footer(run_help);

        add_truth(*app.add_subcommand("truth", "A frame by ray tracing, with any number of fragments per pixel"),
                  truth);
        add_accuracy(*app.add_subcommand("accuracy", "A rendering method's error beside its run time"), accuracy);
        add_geometry(*app.add_subcommand("geometry", "What limits the geometry feed of a scene, and what helps"),
                     geometry);

        command = app.add_subcommand("validate", "The model beside published measurements");
        command->add_option("target", validate.target, "What to validate: geometry, peeling or deferred")
            ->required()
            ->type_name("WHAT");
        command->add_flag("--leave-one-out", validate.leave_one_out,
                          "Also how predictions move when other rows determine the calibrated numbers");
        command
            ->add_option("--lights", validate.lights,
                         "deferred: frames with these numbers of lights, separated by commas (default: all that were "
                         "measured)")
            ->type_name("NUMBERS");
        command
            ->add_option("--size", validate.size,
                         "deferred: pixels of the picture; shadow maps shrink with it (default: as measured)")
            ->type_name("WxH");
        command->add_option("--out", validate.directory, "Folder for validation.json, tables and a page")
            ->type_name("DIR");
        add_measure(
            *command, validate, validate_help,
            "geometry: estimate or detailed (default detailed); peeling: sampled or detailed (default sampled); "
            "deferred: detailed");

        command = app.add_subcommand("calibrate", "Fit numbers of GPU files to published measurements");
        command->add_option("target", calibrate.target, "What to calibrate: geometry or peeling")
            ->required()
            ->type_name("WHAT");
        command->add_option("--write", calibrate.directory, "Folder of GPU files to write the numbers into")
            ->type_name("DIR");
        command
            ->add_option("--folds", calibrate.folds,
                         "Instead: leave the rows out in N parts, fit all numbers to the others, print what becomes "
                         "of those left out (geometry: with estimates)")
            ->type_name("N");
        command->add_option("--seed", calibrate.seed, "Seed of which row is in which fold (default 1)")->type_name("N");
        command->add_option("--out", calibrate.out, "Folder for calibration.json and tables")->type_name("DIR");
        add_measure(
            *command, calibrate, calibrate_help,
            "geometry: estimate or detailed (default detailed); peeling: sampled or detailed (default sampled)");

        command = app.add_subcommand("study", "One question: a sweep, a table and a plot");
        command->add_option("study", study.target, "Name of a study or a .toml file; none: list them")
            ->type_name("STUDY");
        command->add_option("--out", study.directory, "Folder for the table and a page with the plot")
            ->type_name("DIR");
        command->add_flag("--resume,!--no-resume", study.resume,
                          "Take points that were finished before from the folder of --out (default), or compute all "
                          "of them again");
        add_measure(*command, study, study_help);

        add_sensitivity(*app.add_subcommand("sensitivity", "How much a comparison depends on what is assumed"),
                        sensitivity);

        add_stability(*app.add_subcommand("stability", "Stiff and extreme cases beside exact arithmetic"), stability);
        add_capture(*app.add_subcommand("capture", "A frame with all that it draws, as a draw trace"), capture);
        add_record(*app.add_subcommand("record", "Frames that a program draws with OpenGL, as a draw trace"), record);
        add_import(*app.add_subcommand("import", "Frames of an apitrace file, as a draw trace"), import_frames);
        add_replay(*app.add_subcommand("replay", "Run several k-buffer designs on the frame of a draw trace"), replay);
        add_trace(
            *app.add_subcommand("trace", "What a draw trace holds, whether it is whole, where two differ; parts of it"),
            trace);
        command = app.add_subcommand("describe", "Say what can be chosen and what the numbers mean");
        command
            ->add_option(
                "topic", describe.topic,
                "gpus, designs, programs, workloads, generators, preparations, studies, stability, ... or a name")
            ->type_name("TOPIC");
        command->add_flag("--json", describe.json, "Print one JSON document");
        command->add_flag("--names", describe.names, "Print names only, one a line");
        command->footer(describe_help);
        for (CLI::App* each : app.get_subcommands({})) each->allow_extras();
        app.allow_extras();
    }

    CLI::App app;
    CompareCommand compare;
    RunCommand run;
    TruthCommand truth;
    AccuracyCommand accuracy;
    GeometryCommand geometry;
    ValidateCommand validate;
    CalibrateCommand calibrate;
    StudyCommand study;
    SensitivityCommand sensitivity;
    StabilityCommand stability;
    CaptureCommand capture;
    RecordCommand record;
    ImportCommand import_frames;
    ReplayCommand replay;
    TraceCommand trace;
    DescribeCommand describe;
    bool version = false;
};

std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

std::vector<std::string> subcommands(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    return names;
}

// What nothing took: a mistyped option, or one argument too many.
void refuse_extras(const CLI::App& command) {
    std::vector<std::string> extras = command.remaining();
    std::erase(extras, "--"); // behind it stand the words of a program
    if (extras.empty()) return;
    const std::string place = command.get_parent() == nullptr ? "" : command.get_name() + ": ";
    const auto is_option = [](const std::string& word) { return word.size() > 1 && word.front() == '-'; };
    const auto option = std::find_if(extras.begin(), extras.end(), is_option);
    if (option != extras.end()) {
        const std::string name = option->substr(0, option->find('='));
        const char* const whose = command.get_name() == "record" ? " (those of the program stand behind --)" : "";
        throw UsageError(
            fmt::format("{}unknown option {}{}{}", place, name, sim::did_you_mean(name, option_names(command)), whose));
    }
    if (command.get_parent() == nullptr)
        throw UsageError(fmt::format("unknown subcommand '{}'{}", extras.front(),
                                     sim::did_you_mean(extras.front(), subcommands(command))));
    throw UsageError(fmt::format("{}unexpected argument '{}'", place, extras.front()));
}

std::string one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

// A required argument is missed before an unknown option is found; the unknown option is the mistake to report.
void refuse_extras_of(const CLI::App& app) {
    refuse_extras(app);
    for (const CLI::App* command : app.get_subcommands()) refuse_extras(*command);
}

} // namespace

Command parse_command_line(const std::vector<std::string>& arguments) {
    Parser parser;
    CLI::App& app = parser.app;
    try {
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::CallForHelp&) {
        const auto chosen = app.get_subcommands();
        return ShowText{chosen.empty() ? app.help() : chosen.front()->help("ropsim")};
    } catch (const CLI::ParseError& error) {
        refuse_extras_of(app);
        const auto chosen = app.get_subcommands();
        throw UsageError(
            one_line(fmt::format("{}{}", chosen.empty() ? "" : chosen.front()->get_name() + ": ", error.what())));
    }
    refuse_extras_of(app);
    if (parser.version)
        return ShowText{fmt::format("ropsim {} ({})\n", reports::version_text(), reports::build_text())};
    if (app.got_subcommand("compare")) return parser.compare;
    if (app.got_subcommand("run")) return parser.run;
    if (app.got_subcommand("truth")) return parser.truth;
    if (app.got_subcommand("accuracy")) return parser.accuracy;
    if (app.got_subcommand("geometry")) return parser.geometry;
    if (app.got_subcommand("validate")) return parser.validate;
    if (app.got_subcommand("calibrate")) return parser.calibrate;
    if (app.got_subcommand("study")) return parser.study;
    if (app.got_subcommand("sensitivity")) return parser.sensitivity;
    if (app.got_subcommand("stability")) return parser.stability;
    if (app.got_subcommand("capture")) return parser.capture;
    if (app.got_subcommand("record")) return parser.record;
    if (app.got_subcommand("import")) return parser.import_frames;
    if (app.got_subcommand("replay")) return parser.replay;
    if (app.got_subcommand("trace")) return parser.trace;
    if (app.got_subcommand("describe")) return parser.describe;
    throw UsageError(fmt::format("expected a subcommand: {}; see ropsim --help", fmt::join(subcommands(app), ", ")));
}

} // namespace cli
