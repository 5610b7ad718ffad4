// Random discs: curved edges, tunable mean depth complexity.
#include "sim/check.hpp"
#include "traces/generators/screen.hpp"
#include "traces/generators/table.hpp"

#include <cmath>
#include <numbers>

namespace traces {

namespace {

struct DiscsParams {
    std::uint32_t n = 1000;
    double overlap = 8.0;
    std::uint32_t width = 512;
    std::uint32_t height = 512;
    std::uint32_t segments = 32;
    std::uint64_t seed = 1;

    static constexpr auto fields() {
        using P = DiscsParams;
        return std::tuple(
            sim::field<&P::n>("discs").range(1, 1'000'000),
            sim::field<&P::overlap>("mean number of discs over a pixel; gives the radius").range(1e-3, 1e4),
            sim::field<&P::width>("width of the area").unit("px").range(1, 16384),
            sim::field<&P::height>("height of the area").unit("px").range(1, 16384),
            sim::field<&P::segments>("triangles of a disc").range(3, 1024),
            sim::field<&P::seed>("of positions and depths"));
    }
};
static_assert(sim::fully_described<DiscsParams>);

// A fan round the centre, as a list of triangles: all discs are one draw.
void add_disc(Mesh& mesh, const glm::vec3& centre, double radius, std::uint32_t segments, Colour colour) {
    const auto hub = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(centre);
    for (std::uint32_t i = 0; i < segments; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / segments;
        mesh.positions.push_back(centre + glm::vec3(radius * std::cos(angle), radius * std::sin(angle), 0.0));
        for (const std::uint32_t corner : {hub, hub + 1 + (i + 1) % segments, hub + 1 + i})
            mesh.indices.push_back(corner);
    }
    mesh.colours.insert(mesh.colours.end(), segments + 1, colour);
}

Scene build(const DiscsParams& params) {
    const double area = static_cast<double>(params.width) * params.height;
    const double corners = params.segments;
    const double polygon = corners / 2.0 * std::sin(2.0 * std::numbers::pi / corners); // area of the disc of radius 1
    const double radius = std::sqrt(params.overlap * area / (params.n * polygon));
    if (2.0 * radius > std::min(params.width, params.height))
        throw sim::InputError(
            fmt::format("gen:discs: n: expected enough discs for an overlap of {} with discs that fit into "
                        "{}x{} px (radius {:.1f}), got {}",
                        params.overlap, params.width, params.height, radius, params.n));
    sim::Random random(params.seed, "discs");
    Mesh mesh;
    mesh.name = "discs";
    for (std::uint32_t i = 0; i < params.n; ++i) {
        const double x = radius + random.uniform() * (params.width - 2.0 * radius);
        const double y = radius + random.uniform() * (params.height - 2.0 * radius);
        const double depth = (static_cast<double>(random.below(0x7ffffe)) + 1.0) * 0x1.0p-23;
        add_disc(mesh, glm::vec3(x, y, depth), radius, params.segments, colour_of(i));
    }
    return screen_scene(mesh);
}

} // namespace

Generator discs_generator() {
    return make_generator<DiscsParams>("discs", "n random discs with a given mean overlap, as fans in one draw", build);
}

} // namespace traces
