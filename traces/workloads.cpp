#include "traces/workloads.hpp"

#include "sim/check.hpp"
#include "sim/suggest.hpp"
#include "traces/pass_graph.hpp"
#include "traces/user_programs.hpp"
#include "traces/workloads/methods.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <numeric>

namespace traces {

void WorkloadOptions::set(std::string_view assignment) { add_assignment(*values, assignment, "workload"); }

WorkloadOptions WorkloadOptions::of(const std::vector<std::string>& assignments) {
    WorkloadOptions options;
    for (const std::string& assignment : assignments) options.set(assignment);
    return options;
}

const std::vector<Workload>& workloads() {
    static const std::vector<Workload> list = {transparency_workload(),   opaque_workload(),       blended_workload(),
                                               geometry_workload(),       translucency_workload(), csg_workload(),
                                               depth_of_field_workload(), isosurface_workload(),   volume_workload(),
                                               particles_workload(),      soft_shadows_workload(), deferred_workload()};
    return list;
}

pipeline::Frame frame_of(const Scene& scene, const pipeline::View& view) {
    pipeline::Frame frame;
    frame.resources = scene.resources;
    frame.draws = scene.draws;
    frame.view = view;
    return frame;
}

void add_picture(PassGraph& graph, const pipeline::Frame& frame, const models::MakePicture& picture,
                 Composite composite, bool over_surface) {
    graph.add_surface(picture_surface, pipeline::SurfaceFormat::rgba32f);
    ShadedPass pass;
    pass.name = "picture";
    pass.shader = picture({frame.program, frame.view, glm::vec3(frame.background), over_surface});
    pass.reads = {kbuffer_surface};
    if (over_surface) pass.reads.emplace_back(colour_surface);
    pass.targets = {picture_surface};
    pass.screen = true;
    pass.timed = composite == Composite::timed;
    graph.add_shaded(std::move(pass));
    graph.output(picture_surface);
}

namespace {

PassGraph filled(const pipeline::Frame& frame, pipeline::FragmentColour colour) {
    std::vector<std::uint32_t> all(frame.draws.size());
    std::iota(all.begin(), all.end(), 0U);
    PassGraph graph(frame);
    graph.use(colour);
    graph.add_clear("clear k-buffer", {kbuffer_surface});
    graph.add_draw("geometry", {}, {kbuffer_surface}, std::move(all), true);
    return graph;
}

} // namespace

pipeline::Frame kbuffer_frame(const pipeline::Frame& frame, const models::MakePicture& picture, Composite composite,
                              pipeline::FragmentColour colour) {
    PassGraph graph = filled(frame, colour);
    add_picture(graph, frame, picture, composite);
    return graph.lower();
}

pipeline::Frame kbuffer_frame(const pipeline::Frame& frame, std::shared_ptr<const pipeline::Kernel> picture) {
    PassGraph graph = filled(frame, pipeline::FragmentColour::lit);
    graph.add_surface(picture_surface, pipeline::SurfaceFormat::rgba32f);
    graph.add_kernel("picture", std::move(picture), {kbuffer_surface}, {picture_surface});
    graph.output(picture_surface);
    return graph.lower();
}

Workload taking(Workload workload, void (*change)(WorkloadOptions&, const std::string&), const std::string& name) {
    const auto changed = [change, name](auto function) {
        return [function = std::move(function), change, name](const Scene& scene, const auto& seen,
                                                              WorkloadOptions options) {
            change(options, name);
            return function(scene, seen, options);
        };
    };
    workload.build = changed(std::move(workload.build));
    if (workload.truth) workload.truth = changed(std::move(workload.truth));
    workload.all_parameters = [all = std::move(workload.all_parameters), change, name](WorkloadOptions options) {
        change(options, name);
        return all(options);
    };
    return workload;
}

std::string key_of(sim::DescribedRef parameters) { return sim::to_json(parameters).dump(); }

void as_text(WorkloadOptions& options, const std::string& name) {
    const auto found = options.values->find(name);
    if (found != options.values->end() && found->is_number()) *found = found->dump();
}

void as_list(WorkloadOptions& options, const std::string& name) {
    const auto found = options.values->find(name);
    if (found != options.values->end() && found->is_number()) *found = nlohmann::ordered_json::array({*found});
}

void own_k(WorkloadOptions& options, const std::string& k) {
    const auto program = options.values->find("program");
    if (options.values->contains(k) || program == options.values->end() || !program->is_string()) return;
    const auto name = program->get<std::string>();
    if (is_user_program(name)) options.values[k] = usual_entries(name);
}

const std::string& usual_workload() { return workloads().front().id; }

pipeline::Frame build_frame(const Scene& scene, const pipeline::View& view, const WorkloadChoice& workload,
                            const WorkloadOptions& options) {
    pipeline::Frame frame = workload.get().build(scene, view, options);
    frame.workload = workload.name();
    return frame;
}

TruthMethod truth_method(const Scene& scene, const pipeline::Frame& frame, const WorkloadChoice& workload,
                         const WorkloadOptions& options) {
    const Workload& method = workload.get();
    if (method.truth) return method.truth(scene, frame, options);
    std::vector<std::string> known;
    for (const Workload& one : workloads())
        if (one.truth) known.push_back(one.id);
    throw sim::InputError(
        fmt::format("truth: expected a workload of {}, got {}", fmt::join(known, ", "), workload.name()));
}

const Workload& workload_named(const std::string& workload) {
    std::vector<std::string> known;
    for (const Workload& one : workloads()) {
        if (one.id == workload) return one;
        known.push_back(one.id);
    }
    throw sim::InputError(fmt::format("workload: expected one of {}, got '{}'{}", fmt::join(known, ", "), workload,
                                      sim::did_you_mean(workload, known)));
}

} // namespace traces
