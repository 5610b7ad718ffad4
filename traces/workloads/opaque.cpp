// Every draw with depth test and depth write, in one pass: the plain workload, with no k-buffer.
#include "pipeline/format_choice.hpp"
#include "traces/loads.hpp"
#include "traces/pass_graph.hpp"
#include "traces/workloads/methods.hpp"

#include <numeric>

namespace traces {

namespace {

struct OpaqueParams {
    pipeline::DepthChoice depth_format = pipeline::DepthChoice::d24;

    static constexpr auto fields() {
        return std::tuple(sim::field<&OpaqueParams::depth_format>("format of the depth surface"));
    }
};
static_assert(sim::fully_described<OpaqueParams>);

pipeline::Frame build(const Scene& scene, const pipeline::View& view, const OpaqueParams& params) {
    pipeline::Frame frame = frame_of(scene, view);
    frame.depth_format = format_of(params.depth_format);
    std::vector<std::uint32_t> all(frame.draws.size());
    std::iota(all.begin(), all.end(), 0U);

    PassGraph graph(std::move(frame));
    graph.add_clear("clear", {depth_surface, colour_surface});
    graph.add_draw("opaque", {depth_surface}, {depth_surface, colour_surface}, std::move(all));
    graph.output(colour_surface);
    return graph.lower();
}

TruthMethod truth(const Scene&, const pipeline::Frame&, const OpaqueParams&) { return layered_truth(); }

} // namespace

Workload opaque_workload() {
    return make_workload<OpaqueParams>("opaque", "every draw with depth test and depth write; no k-buffer", build,
                                       truth);
}

Load nearest_surface_load() { return {"opaque"}; }

} // namespace traces
