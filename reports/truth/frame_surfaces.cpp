#include "reports/truth/frame_surfaces.hpp"

#include <algorithm>
#include <utility>

namespace reports {

namespace {

/// Triangles turn the other way on the screen, y up, than a ray sees them.
bool mirrors(const pipeline::View& view, double sense) {
    const glm::dmat4 projection(view.projection);
    return sense * glm::determinant(glm::dmat3(glm::dmat4(view.view))) * projection[0][0] * projection[1][1] < 0.0;
}

bool is_doubtful(const RayHit& hit) {
    return std::min({hit.u, hit.v, 1.0 - hit.u - hit.v}) < doubtful_edge || hit.cosine < doubtful_cosine;
}

FrameSurface surface_of(const RayHit& hit, double distance, bool front, const HitShading::Shaded& shaded) {
    return {distance, hit.draw, front, shaded.colour, shaded.normal, shaded.texcoords, shaded.tangent, shaded.lane};
}

} // namespace

FrameSurfaces::FrameSurfaces(const pipeline::Frame& frame, const RayScene& scene, const PixelRays& rays, Hides hides)
    : roles_(frame.draws.size()),
      view_mirrors_(mirrors(frame.view, rays.sense())),
      rays_(rays),
      shading_(frame, scene, rays),
      hides_(std::move(hides)) {
    for (const pipeline::Pass& pass : frame.passes)
        for (const std::uint32_t draw : pass.draws)
            if (pass.runs_program() || pass.writes_depth())
                roles_[draw] = {pass.runs_program() ? Role::layer : Role::opaque, pass.both_faces};
    for (const pipeline::Draw& draw : frame.draws)
        for (const glm::mat4& model : draw.instances)
            culling_.push_back(pipeline::culling_of(frame.resources->materials[draw.material].double_sided, model));
}

bool FrameSurfaces::culled(const RayHit& hit, bool counter_clockwise) const {
    if (roles_[hit.draw].both_faces) return false;
    const pipeline::Culling culling = culling_[hit.mesh];
    return culling == (counter_clockwise ? pipeline::Culling::counter_clockwise : pipeline::Culling::clockwise);
}

void FrameSurfaces::find(std::span<const RayHit> hits, std::uint32_t x, std::uint32_t y,
                         PixelSurfaces& surfaces) const {
    surfaces.layers.clear();
    surfaces.has_opaque = false;
    surfaces.doubtful = false;
    for (const RayHit& hit : hits) {
        const Role role = roles_[hit.draw].role;
        const bool front = hit.front != view_mirrors_; // a mirroring view turns all triangles round
        if (role == Role::none || culled(hit, front)) continue;
        surfaces.doubtful = surfaces.doubtful || is_doubtful(hit);
        const HitShading::Shaded shaded = shading_(hit, x, y);
        if (!shaded.alive) continue;
        const FrameSurface surface = surface_of(hit, rays_.distance(hit.t), front, shaded);
        if (role == Role::layer || (hides_ && !hides_(surface))) {
            surfaces.layers.push_back(surface);
            continue;
        }
        surfaces.opaque = surface;
        surfaces.has_opaque = true;
        return; // it hides the rest
    }
}

std::optional<FrameSurface> FrameSurfaces::along_ray(const RayHit& hit) const {
    if (roles_[hit.draw].role == Role::none || culled(hit, hit.front)) return std::nullopt;
    const HitShading::Shaded shaded = shading_(hit);
    if (!shaded.alive) return std::nullopt;
    return surface_of(hit, hit.t, hit.front, shaded);
}

} // namespace reports
