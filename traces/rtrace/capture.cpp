// A scene and a rendering method as a trace, and back to a frame.
#include "sim/check.hpp"
#include "traces/camera.hpp"
#include "traces/recording/lower.hpp"
#include "traces/trace.hpp"
#include "traces/user_programs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace traces {

namespace {

// A trace that named a file would not be self-contained, and would have it read by whoever replays it.
void take_in_programs(const Workload& workload, sim::JsonValue& parameters) {
    for (const ProgramParameter& name : workload.program_parameters)
        parameters[name.program] =
            self_contained(parameters[name.program].get<std::string>(), parameters[name.k].get<std::uint32_t>(),
                           parameters[name.opacity].get<float>());
}

void leave_out_maps(pipeline::Resources& resources) {
    resources.maps.clear();
    for (pipeline::Material& material : resources.materials) material.maps = {};
}

void refuse_program_files(const Workload& workload, const WorkloadOptions& options, const std::string& place) {
    for (const ProgramParameter& name : workload.program_parameters) {
        const auto found = options.values->find(name.program);
        if (found == options.values->end() || !found->is_string()) continue;
        const auto program = found->get<std::string>();
        if (is_program_file(program))
            throw sim::InputError(
                fmt::format("{}: parameter {}: expected a program's text, got the name of a file, '{}'", place,
                            name.program, program));
    }
}

WorkloadOptions options_of(const Trace& trace) {
    auto values = nlohmann::ordered_json::parse(trace.frame.parameters, nullptr, false);
    if (!values.is_object())
        throw sim::InputError(fmt::format("{}: parameters of the workload: expected a JSON object", trace.scene.name));
    WorkloadOptions options;
    options.values = sim::JsonValue(std::move(values));
    return options;
}

} // namespace

Trace capture(const CaptureRequest& request) {
    Trace trace;
    CapturedFrame& frame = trace.frame;
    const Workload& workload = workload_named(request.workload);
    const WorkloadOptions options = WorkloadOptions::of(request.settings);
    frame.workload = request.workload;
    frame.options = options.values->dump();
    sim::JsonValue parameters = workload.all_parameters(options);
    take_in_programs(workload, parameters);
    frame.parameters = parameters->dump();
    trace.scene = load_scene(request.scene);
    trace.metadata = {request.writer, request.name.empty() ? trace.scene.name : request.name, request.licence,
                      trace.scene.name, trace.scene.hash};
    frame.camera = request.camera;
    frame.view = make_view(trace.scene, request.camera, request.width, request.height, &frame.notes);
    frame.view.samples = request.samples;
    if (!workload.reads_maps) leave_out_maps(*trace.scene.resources);
    trace.scene.resources->read_textures();
    frame_of(trace);
    return trace;
}

pipeline::Frame frame_of(const Trace& trace, const ReplayOptions& replay) {
    if (trace.recording) {
        LowerOptions options = LowerOptions::of(*trace.recording, replay.frames, replay.kbuffer, replay.k);
        options.cold = replay.cold;
        return lower(*trace.recording, options, trace.scene.name);
    }
    if (!replay.frames.empty() || !replay.kbuffer.empty())
        throw sim::InputError(
            fmt::format("{}: {}: expected a recording of an application's frames, got a captured frame",
                        replay.frames.empty() ? "--kbuffer" : "--frames", trace.scene.name));
    const WorkloadOptions options = options_of(trace);
    refuse_program_files(workload_named(trace.frame.workload), options, trace.scene.name);
    return build_frame(trace.scene, trace.frame.view, trace.frame.workload, options);
}

} // namespace traces
