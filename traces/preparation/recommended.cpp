// A4b, the layout that measurements recommend: at most 65,536 vertices per draw with 16-bit indices, cache-friendly
// order, attributes side by side, floats for everything but colours, which are four unsigned bytes (specification 004,
// sections 3.1, 4.6).
#include "sim/check.hpp"
#include "sim/counted.hpp"
#include "traces/preparation/conservation.hpp"
#include "traces/preparation/formats.hpp"
#include "traces/preparation/rebuild.hpp"
#include "traces/preparation/steps.hpp"
#include "traces/preparation/table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace traces {

using pipeline::ComponentType;
using pipeline::Semantic;

namespace {

struct RecommendedParams {
    std::uint32_t cache = 16;
    std::uint32_t vertices = 65536;

    static constexpr auto fields() {
        using P = RecommendedParams;
        return std::tuple(
            sim::field<&P::cache>("shaded vertices that the FIFO holds").unit("vertices").range(3, 65536),
            sim::field<&P::vertices>("distinct vertices of a draw at most").unit("vertices").range(3, 65536));
    }
};
static_assert(sim::fully_described<RecommendedParams>);

Scene ordered_in_batches(Scene scene, const RecommendedParams& params) {
    const DrawnTriangles before = drawn_triangles(scene);
    scene = rebuild_scene(std::move(scene), TopologyWanted::list, [&](TriangleMesh mesh) {
        reorder_mesh(mesh, {.algorithm = ReorderAlgorithm::fifo, .cache = params.cache, .fetch = true});
        std::vector<PreparedPart> parts;
        for (TriangleMesh& part : cut_into_batches(std::move(mesh), params.vertices, 0))
            parts.push_back({std::move(part)});
        return parts;
    });
    check_same_triangles(before, drawn_triangles(scene), false);
    return scene;
}

/// Returns the largest change of a component.
double colours_as_bytes(Column& column) {
    const std::vector<glm::vec4> before = values_of(column);
    column = column_from(with_format(column.format, ComponentType::u8, 4, true), before);
    const std::vector<glm::vec4> after = values_of(column);
    double largest = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i)
        for (int c = 0; c < 4; ++c)
            largest =
                std::max(largest, std::fabs(static_cast<double>(before[i][c]) - static_cast<double>(after[i][c])));
    return largest;
}

/// Returns the largest change of a colour's component.
double change_formats(TriangleMesh& mesh) {
    Columns columns = columns_of(mesh);
    double largest = 0.0;
    for (Column& column : columns) {
        if (pipeline::slot_of(column.format.semantic) == pipeline::Slot::colour)
            largest = std::max(largest, colours_as_bytes(column));
        else if (column.format.type != ComponentType::f32)
            column = column_from(with_format(column.format, ComponentType::f32, column.format.components, false),
                                 values_of(column));
    }
    lay_out(mesh, columns, grouping_of(mesh), 4);
    interleave_mesh(mesh, VertexLayout::interleaved, 4);
    return largest;
}

Applied apply(Scene scene, const RecommendedParams& params) {
    const std::size_t draws = scene.draws.size();
    const Scene batched = ordered_in_batches(std::move(scene), params);
    double colour_error = 0.0;
    Applied applied;
    applied.scene = change_meshes(batched, TopologyWanted::as_it_is, [&](TriangleMesh& mesh) {
        colour_error = std::max(colour_error, change_formats(mesh));
    });
    const std::array changed{Semantic::colour, Semantic::secondary_colour};
    CHECK(check_same_order(batched, applied.scene, changed) == 0.0);
    applied.notes.push_back(fmt::format("{} became {}", sim::counted(draws, "draw"), applied.scene.draws.size()));
    if (colour_error > 0.0) applied.notes.push_back(fmt::format("colours: largest error {:.2g}", colour_error));
    return applied;
}

} // namespace

Preparation recommended_preparation() {
    return make_preparation<RecommendedParams>(
        "recommended", "order, batches, 16-bit indices, interleaved floats with colours as bytes (A4b)", apply);
}

} // namespace traces
