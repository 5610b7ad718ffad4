// The rendering methods, one file each.
#pragma once

#include "models/programs/picture_shader.hpp"
#include "traces/parameters.hpp"
#include "traces/pass_graph.hpp"
#include "traces/workloads.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace traces {

Workload transparency_workload();
Workload opaque_workload();
Workload blended_workload();
Workload geometry_workload();
Workload translucency_workload();
Workload csg_workload();
Workload depth_of_field_workload();
Workload isosurface_workload();
Workload volume_workload();
Workload particles_workload();
Workload soft_shadows_workload();
Workload deferred_workload();

/// What tells one set of parameters from another.
std::string key_of(sim::DescribedRef parameters);

/// A row of the table of workloads; `build` takes (scene, view, parameters), `truth` the frame in place of the view.
template <sim::Described P>
Workload make_workload(std::string id, std::string summary,
                       pipeline::Frame (*build)(const Scene&, const pipeline::View&, const P&),
                       TruthMethod (*truth)(const Scene&, const pipeline::Frame&, const P&) = nullptr) {
    const std::string place = fmt::format("workload {}", id);
    Workload workload;
    workload.id = std::move(id);
    workload.summary = std::move(summary);
    workload.parameters = sim::describe<P>();
    workload.build = [place, build](const Scene& scene, const pipeline::View& view, const WorkloadOptions& options) {
        return build(scene, view, read_parameters<P>(options.values, place));
    };
    workload.all_parameters = [place](const WorkloadOptions& options) {
        return sim::JsonValue(sim::to_json(read_parameters<P>(options.values, place)));
    };
    if (truth != nullptr)
        workload.truth = [place, truth](const Scene& scene, const pipeline::Frame& frame,
                                        const WorkloadOptions& options) {
            const P parameters = read_parameters<P>(options.values, place);
            TruthMethod method = truth(scene, frame, parameters);
            if (!method.key) method.key = key_of(sim::DescribedRef(parameters));
            return method;
        };
    return workload;
}

/// What frames of all workloads have in common: the scene with all its draws, seen through `view`.
pipeline::Frame frame_of(const Scene& scene, const pipeline::View& view);

/// Whether the pass that makes a picture of a k-buffer takes time. Published times leave it out.
enum class Composite : std::uint8_t { free, timed };

/// The parameter of the workloads that have such a pass; their parameters have a member of the name.
template <class P>
constexpr auto composite_field() {
    return sim::field<&P::composite>("whether the pass that makes the picture of the k-buffer takes time");
}

/// Appends the pass that makes the frame's picture of its k-buffer: over the colour surface, or over the background.
/// The picture is the output.
void add_picture(PassGraph& graph, const pipeline::Frame& frame, const models::MakePicture& picture,
                 Composite composite = Composite::free, bool over_surface = false);

/// The graph of the methods that do nothing but fill a k-buffer: clear, all draws with both faces through the frame's
/// program, and the picture.
pipeline::Frame kbuffer_frame(const pipeline::Frame& frame, const models::MakePicture& picture, Composite composite,
                              pipeline::FragmentColour colour = pipeline::FragmentColour::lit);
/// With a picture that a kernel makes, which takes no time.
pipeline::Frame kbuffer_frame(const pipeline::Frame& frame, std::shared_ptr<const pipeline::Kernel> picture);

/// The workload with `change(options, name)` applied to what it is given: as_text(), as_list(), own_k().
Workload taking(Workload workload, void (*change)(WorkloadOptions&, const std::string&), const std::string& name);

/// Makes a text of a parameter that may be a number.
void as_text(WorkloadOptions& options, const std::string& name);

/// Makes a list of one of a parameter that may be a number or a list of numbers.
void as_list(WorkloadOptions& options, const std::string& name);

/// Sets the parameter `k`, where it is not given, to the entries that a program of the user's has.
void own_k(WorkloadOptions& options, const std::string& k);

} // namespace traces

template <>
struct sim::EnumNames<traces::Composite> {
    static constexpr std::array<std::string_view, 2> names{"free", "timed"};
};
