// Constructive solid geometry: per pixel, the first point inside a Boolean expression of the drawn objects.
//
// Source: Bavoil 2007, section 6.1.3 (specification 004, A13). Each draw is an object with a closed surface. A pixel
// with more than k fragments loses those behind, exits among them; reports count such pixels.
#include "models/programs/nearest_k.hpp"
#include "traces/workloads/csg_picture.hpp"
#include "traces/workloads/methods.hpp"

namespace traces {

namespace {

struct CsgParams {
    std::string expression;
    std::uint32_t k = 8;
    std::array<float, 3> background = {1.0F, 1.0F, 1.0F};
    Composite composite = Composite::free;

    static constexpr auto fields() {
        using P = CsgParams;
        return std::tuple(
            sim::field<&P::expression>("which points belong to the solid: draws as letters (A is the first) or numbers "
                                       "(from 0), ! - & ^ | that bind as in C, parentheses; nothing: A|B|C...; as in "
                                       "'A & !B'"),
            sim::field<&P::k>("fragments kept per pixel; all of a pixel must fit").unit("fragments").range(1, 64),
            sim::field<&P::background>("linear RGB behind everything").range(0.0F, 1.0F), composite_field<P>());
    }
};
static_assert(sim::fully_described<CsgParams>);

std::string expression_of(const CsgParams& params, std::size_t draws) {
    if (params.expression.find_first_not_of(" \t") != std::string::npos) return params.expression;
    std::string all = "0";
    for (std::size_t draw = 1; draw < draws; ++draw) all += fmt::format("|{}", draw);
    return all;
}

CsgExpression read_expression(const CsgParams& params, std::size_t draws) {
    return {expression_of(params, draws), static_cast<std::uint32_t>(draws)};
}

pipeline::Frame build(const Scene& scene, const pipeline::View& view, const CsgParams& params) {
    pipeline::Frame frame = frame_of(scene, view);
    frame.program = models::make_nearest_k(models::EntryKind::zo, params.k);
    frame.background = {params.background[0], params.background[1], params.background[2], 1.0F};
    const CsgExpression expression = read_expression(params, frame.draws.size());
    return kbuffer_frame(frame, csg_picture(frame, expression), params.composite);
}

std::vector<std::optional<double>> distances_of(const CsgSurface& surface) {
    std::vector<std::optional<double>> distances;
    distances.reserve(surface.objects.size());
    for (std::uint32_t y = 0; y < surface.image.height(); ++y)
        for (std::uint32_t x = 0; x < surface.image.width(); ++x)
            distances.push_back(surface.image.sees(x, y) ? std::optional(surface.image.distance(x, y)) : std::nullopt);
    return distances;
}

// The first point of the solid. Its picture needs the whole of it, as normals are differences of depths; these are
// uncertain at every edge, so distances are compared and not colours.
TruthMethod truth(const Scene&, const pipeline::Frame& frame, const CsgParams& params) {
    const auto expression = std::make_shared<const CsgExpression>(read_expression(params, frame.draws.size()));
    const auto solid = std::make_shared<CsgSurface>(
        CsgSurface{SurfaceImage(frame.view), std::vector<std::uint32_t>(frame.view.pixels())});
    TruthMethod method;
    method.channels = {{"solid", "distance", false}};
    method.pixel = [expression, solid](Rays& rays, const PixelSurfaces& surfaces, std::uint32_t x, std::uint32_t y,
                                       TruthPicture& picture) {
        CsgWalk walk(*expression, rays.frame().draws.size());
        for (const FrameSurface& layer : surfaces.layers) {
            if (!walk.cross(layer.draw)) continue;
            const std::size_t pixel = picture.pixel(x, y);
            picture.channels[0].set(pixel, layer.distance);
            solid->image.set_distance(pixel, layer.distance);
            solid->objects[pixel] = layer.draw;
            return;
        }
    };
    method.finish = [solid](const pipeline::Frame& drawn, TruthPicture& picture) {
        picture.colours = shaded(drawn, *solid);
    };
    method.rasterized = [expression](const pipeline::Frame& drawn, const pipeline::ReferenceImage& reference) {
        return distances_of(csg_surface(drawn, reference.kbuffer, *expression));
    };
    return method;
}

} // namespace

Workload csg_workload() {
    Workload workload =
        taking(make_workload<CsgParams>(
                   "csg", "constructive solid geometry: the first point inside a Boolean expression of the draws",
                   build, truth),
               as_text, "expression"); // one that is a number reads as such
    workload.examples = {{"truth", "gen:csg --workload csg --set 'workload.expression=A & !B' --check"}};
    return workload;
}

} // namespace traces
