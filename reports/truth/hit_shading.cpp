#include "reports/truth/hit_shading.hpp"

#include "reports/truth/plane_weights.hpp"

#include <cmath>

namespace reports {

namespace {

/// What the fragments of each draw are asked for: by the shader of the pass that draws it, or by the whole frame.
std::vector<pipeline::Needs> needs_of_draws(const pipeline::Frame& frame) {
    std::vector<pipeline::Needs> needs(frame.draws.size(), frame.needs);
    for (const pipeline::Pass& pass : frame.passes)
        if (pass.shader != nullptr && (pass.runs_program() || pass.writes_depth()))
            for (const std::uint32_t draw : pass.draws) needs[draw] = frame.needs_of(pass);
    return needs;
}

pipeline::ShaderOptions shader_options(const pipeline::Frame& frame, const pipeline::Needs& needs) {
    return {.colours = needs.colours,
            .normals = needs.fragment_normals,
            .map_texcoords = needs.map_texcoords,
            .fragment_colour = needs.fragment_colour,
            .perspective = frame.view.projection[2][3] != 0.0F,
            .textures = needs.textures,
            .alpha_test = needs.alpha_test};
}

/// The pixel's place in its 2x2 block.
constexpr std::uint32_t lane_of(std::uint32_t x, std::uint32_t y) { return (y & 1U) * 2 + (x & 1U); }

/// Four times the place of the hit: no footprint.
pipeline::CornerWeights own_weights(const RayHit& hit) {
    pipeline::CornerWeights weights;
    weights.of1.fill(static_cast<float>(hit.u));
    weights.of2.fill(static_cast<float>(hit.v));
    return weights;
}

} // namespace

HitShading::HitShading(const pipeline::Frame& frame, const RayScene& scene, const PixelRays& rays)
    : scene_(scene), rays_(rays), to_world_(glm::transpose(glm::dmat3(glm::dmat4(frame.view.view)))) {
    const std::vector<pipeline::Needs> needs = needs_of_draws(frame);
    for (std::size_t i = 0; i < needs.size(); ++i) {
        const pipeline::Draw& draw = scene.draws()[i];
        for (const glm::mat4& model : draw.instances)
            shaders_.emplace_back(scene.resources(), scene.resources().geometries[draw.geometry],
                                  scene.resources().materials[draw.material], frame.view.view * model,
                                  shader_options(frame, needs[i]));
    }
}

// Where a neighbour's ray misses the plane, or meets it behind the eye or far away, it takes the hit's own weights: no
// footprint comes from there.
pipeline::CornerWeights HitShading::weights(const RayHit& hit, std::uint32_t x, std::uint32_t y) const {
    constexpr double largest = 1e6;
    pipeline::CornerWeights weights = own_weights(hit);
    if (!shaders_[hit.mesh].samples() && !shaders_[hit.mesh].gives_texcoords()) return weights;
    const auto corners = scene_.corners(hit.mesh, hit.triangle);
    for (std::uint32_t lane = 0; lane < 4; ++lane) {
        if (lane == lane_of(x, y)) continue;
        const WorldRay ray = rays_((x & ~1U) + (lane & 1U), (y & ~1U) + lane / 2);
        const auto met = meet_plane(corners, ray.origin, ray.step);
        if (!met || std::fabs(met->u) > largest || std::fabs(met->v) > largest) continue;
        if (rays_.perspective() && met->t <= 0.0) continue;
        weights.of1[lane] = static_cast<float>(met->u);
        weights.of2[lane] = static_cast<float>(met->v);
    }
    return weights;
}

HitShading::Shaded HitShading::operator()(const RayHit& hit, std::uint32_t x, std::uint32_t y) const {
    return shaded(hit, weights(hit, x, y), lane_of(x, y));
}

HitShading::Shaded HitShading::operator()(const RayHit& hit) const { return shaded(hit, own_weights(hit), 0); }

HitShading::Shaded HitShading::shaded(const RayHit& hit, const pipeline::CornerWeights& weights,
                                      std::uint32_t lane) const {
    const pipeline::FragmentShader& shader = shaders_[hit.mesh];
    if (!shader.needed()) return {};
    const auto triangle = shader.triangle(scene_.vertices(hit.mesh, hit.triangle), nullptr);
    const auto output = shader.shade(triangle, weights, 1U << lane);
    const glm::dvec3 normal = to_world_ * glm::dvec3(output.normals[lane]);
    const double length = glm::length(normal);
    const glm::vec3 tangent(to_world_ * glm::dvec3(triangle.tangent));
    return {output.colours[lane], length > 0.0 ? normal / length : glm::dvec3(0.0), output.alive != 0,
            output.texcoords,     glm::vec4(tangent, triangle.tangent.w),           lane};
}

} // namespace reports
