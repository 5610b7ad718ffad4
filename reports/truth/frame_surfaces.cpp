#include "reports/truth/frame_surfaces.hpp"

#include <algorithm>

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

} // namespace

FrameSurfaces::FrameSurfaces(const pipeline::Frame& frame, const RayScene& scene, const PixelRays& rays)
    : roles_(frame.draws.size()),
      view_mirrors_(mirrors(frame.view, rays.sense())),
      rays_(rays),
      shading_(frame, scene, rays) {
    for (const pipeline::Pass& pass : frame.passes)
        for (const std::uint32_t draw : pass.draws)
            if (pass.runs_program() || pass.writes_depth())
                roles_[draw] = {pass.runs_program() ? Role::layer : Role::opaque, pass.both_faces};
    for (const pipeline::Draw& draw : frame.draws)
        for (const glm::mat4& model : draw.instances)
            culling_.push_back(pipeline::culling_of(frame.resources->materials[draw.material].double_sided, model));
}

// A mirroring view turns all triangles round.
bool FrameSurfaces::culled(const RayHit& hit) const {
    if (roles_[hit.draw].both_faces) return false;
    const bool counter_clockwise = hit.front != view_mirrors_;
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
        if (role == Role::none || culled(hit)) continue;
        surfaces.doubtful = surfaces.doubtful || is_doubtful(hit);
        const HitShading::Shaded shaded = shading_(hit, x, y);
        if (!shaded.alive) continue;
        const FrameSurface surface{rays_.distance(hit.t), hit.draw, glm::vec3(shaded.colour)};
        if (role == Role::layer) {
            surfaces.layers.push_back(surface);
            continue;
        }
        surfaces.opaque = surface;
        surfaces.has_opaque = true;
        return; // it hides the rest
    }
}

} // namespace reports
