#include "cli/frame_options.hpp"

#include "cli/help_texts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace cli {

void add_scene(CLI::App& command, std::string& scene) {
    command
        .add_option("scene", scene,
                    "glTF file (.glb, .gltf), FILE#N for its scene number N, tetrahedra (.vtk, .tetm), or "
                    "gen:NAME?key=value&key=value; +ground behind it lays a floor below the scene")
        ->required()
        ->type_name("SCENE");
}

void add_size(CLI::App& command, std::string& size) {
    command.add_option("--size", size, "Pixels of the frame (default 512x512)")->type_name("WxH");
}

void add_camera(CLI::App& command, std::string& camera) {
    command.add_option("--camera", camera, camera_text)->type_name("CAMERA");
}

void add_threads(CLI::App& command, std::string& threads) {
    command.add_option("--threads", threads, "Threads (default: all cores); results do not depend on it")
        ->type_name("N");
}

void add_workload(CLI::App& command, std::string& workload, const std::string& text) {
    command.add_option("--workload", workload, fmt::format("{} (default {})", text, workload))->type_name("NAME");
}

void add_parameters(CLI::App& command, ParameterValues& values) {
    for (const traces::Workload& workload : traces::workloads())
        for (const traces::ParameterOption& option : workload.options) {
            const std::string name = "--" + option.parameter;
            if (command.get_option_no_throw(name) == nullptr) {
                values.emplace_back(option.parameter, "");
                command.add_option(name, values.back().second, option.help)->type_name(option.value);
            }
        }
}

std::string ids_of(bool (*which)(const traces::Workload&)) {
    std::vector<std::string> ids;
    for (const traces::Workload& workload : traces::workloads())
        if (which(workload)) ids.push_back(workload.id);
    return fmt::format("{}", fmt::join(ids, ", "));
}

std::string averaged_frames() {
    std::vector<std::string> texts;
    for (const traces::Workload& workload : traces::workloads())
        if (workload.averaging) texts.push_back(fmt::format("{}: {}", workload.id, workload.averaging->what));
    return fmt::format("{}", fmt::join(texts, ", "));
}

std::string with_examples(std::string help, const std::string& command) {
    for (const traces::Workload& workload : traces::workloads())
        for (const traces::Example& example : workload.examples)
            if (example.command == command) help += fmt::format("\n  ropsim {} {}", command, example.arguments);
    return help;
}

void add_settings(CLI::App& command, std::vector<std::string>& settings, const std::string& text) {
    command.add_option("--set", settings, text + "; may be repeated")
        ->type_name("PATH=VALUE")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_frame(CLI::App& command, FrameOptions& options) {
    add_scene(command, options.scene);
    add_workload(command, options.workload, "Rendering method");
    add_parameters(command, options.parameters);
    add_size(command, options.size);
    command.add_option("--samples", options.samples, "Samples of a pixel, against jagged edges: 1, 4 or 8 (default 1)")
        ->type_name("N");
    add_camera(command, options.camera);
}

void add_machine(CLI::App& command, FrameOptions& options) {
    command.add_option("--gpu", options.gpu, "Name of a GPU or a .toml file (default neutral)")->type_name("GPU");
    command.add_option("--seed", options.seed, "Seed of everything random in the hardware (default 1)")->type_name("N");
    add_threads(command, options.threads);
}

void add_frame_options(CLI::App& command, FrameOptions& options) {
    add_frame(command, options);
    add_machine(command, options);
    add_settings(command, options.settings,
                 "Overrides a number of the GPU, of a design or of the workload (workload.KEY)");
}

void add_designs(CLI::App& command, CompareCommand& options) {
    command
        .add_option("--designs", options.designs,
                    "Designs to run, separated by commas, or all; each may have settings of its own: "
                    "NAME?key=value&key=value\n(default existing with each visibility,scoreboard,blender,multipass)")
        ->type_name("NAMES");
    command
        .add_option("--equal-area", options.equal_area,
                    "Compare at so many bytes on chip: tile caches get what is left beside all else (without a "
                    "number: as many as the largest design has)")
        ->type_name("BYTES")
        ->default_str("largest")
        ->expected(0, 1);
}

void add_output_options(CLI::App& command, OutputOptions& options) {
    command.add_option("--out", options.directory, "Folder for result.json, tables, report.html and pictures")
        ->type_name("DIR");
    command.add_flag("--json", options.json, "Print result.json on standard output, and nothing else");
    command.add_flag("--no-images", options.no_images, "Write no pictures (OpenImageIO is not loaded)");
}

} // namespace cli
