// The benchmark of the geometry feed: one pass with depth test LESS and depth write and fragments of constant colour.
//
// Source: Bavoil 2007, section 3.2 (specification 004, section 2.2, W1).
#include "pipeline/format_choice.hpp"
#include "traces/loads.hpp"
#include "traces/pass_graph.hpp"
#include "traces/workloads/methods.hpp"

#include <numeric>

namespace traces {

enum class ReadAttributes : std::uint8_t { position, all };

} // namespace traces

template <>
struct sim::EnumNames<traces::ReadAttributes> {
    static constexpr std::array<std::string_view, 2> names{"position", "all"};
};

namespace traces {

namespace {

struct GeometryParams {
    ReadAttributes reads = ReadAttributes::all;
    pipeline::DepthChoice depth_format = pipeline::DepthChoice::d24;

    static constexpr auto fields() {
        using P = GeometryParams;
        return std::tuple(sim::field<&P::reads>("what the vertex shader reads: positions, or all that a vertex has"),
                          sim::field<&P::depth_format>("format of the depth surface"));
    }
};
static_assert(sim::fully_described<GeometryParams>);

pipeline::Frame build(const Scene& scene, const pipeline::View& view, const GeometryParams& params) {
    constexpr std::uint32_t every_attribute = (1U << pipeline::semantics) - 1;
    pipeline::Frame frame = frame_of(scene, view);
    frame.depth_format = format_of(params.depth_format);
    std::vector<std::uint32_t> all(frame.draws.size());
    std::iota(all.begin(), all.end(), 0U);

    PassGraph graph(std::move(frame));
    graph.use(pipeline::FragmentColour::flat);
    graph.add_clear("clear", {depth_surface, colour_surface});
    graph.add_draw("geometry", {depth_surface}, {depth_surface, colour_surface}, std::move(all));
    if (params.reads == ReadAttributes::all) graph.vertex_shader_reads(every_attribute);
    graph.output(colour_surface);
    return graph.lower();
}

} // namespace

Workload geometry_workload() {
    return make_workload<GeometryParams>(
        "geometry", "every draw with depth test and depth write in one colour: the load of the geometry feed", build);
}

Load geometry_feed_load(bool every_attribute) {
    return {"geometry", {every_attribute ? "reads=all" : "reads=position"}};
}

} // namespace traces
