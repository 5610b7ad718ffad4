// Points with a scalar, such as the particles of a simulation (specification 004, section 1.2: 549 k of them).
//
// The workload `particles` draws every vertex as a sprite. For all other workloads three points in a row are a
// triangle.
#include "traces/generators/random_point.hpp"
#include "traces/generators/table.hpp"
#include "traces/tetrahedra/tetrahedral_mesh.hpp"

#include "sim/random.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace traces {

namespace {

struct ParticlesParams {
    std::uint32_t n = 549'000;
    double waves = 0.25;
    std::uint64_t seed = 1;

    static constexpr auto fields() {
        using P = ParticlesParams;
        return std::tuple(
            sim::field<&P::n>("points, evenly distributed in a ball of radius 1").range(3, 40'000'000),
            sim::field<&P::waves>("height of waves in the scalar, which otherwise is the distance from the middle")
                .range(0.0, 1.0),
            sim::field<&P::seed>("of the places"));
    }
};
static_assert(sim::fully_described<ParticlesParams>);

glm::dvec3 point_in_ball(sim::Random& random) {
    for (;;) {
        const glm::dvec3 point = 2.0 * random_in_cube(random) - 1.0;
        if (glm::dot(point, point) <= 1.0) return point;
    }
}

Scene build(const ParticlesParams& params) {
    sim::Random random(params.seed, "particles");
    PointCloud cloud;
    cloud.name = "particles";
    for (std::uint32_t i = 0; i < params.n; ++i) {
        const glm::dvec3 point = point_in_ball(random);
        const double wave = std::sin(6.0 * point.x) * std::sin(6.0 * point.y) * std::sin(6.0 * point.z);
        cloud.positions.emplace_back(glm::vec3(point));
        cloud.scalars.push_back(static_cast<float>(glm::length(point) + params.waves * wave));
    }
    return scene_of(std::move(cloud));
}

} // namespace

Generator particles_generator() {
    return make_generator<ParticlesParams>("particles", "points in a ball with a scalar, for sprites", build);
}

} // namespace traces
