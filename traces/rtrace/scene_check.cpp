#include "traces/rtrace/scene_check.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"
#include "traces/camera.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numbers>

namespace traces::rtrace {

namespace {

class Complaint {
  public:
    Complaint(const Trace& trace, std::string_view kind, std::size_t i)
        : place_(fmt::format("{}: {} {}", trace.scene.name, kind, i)) {}

    template <class... Arguments>
    void require(bool good, fmt::format_string<Arguments...> expected, Arguments&&... arguments) const {
        if (!good)
            throw sim::InputError(
                fmt::format("{}: expected {}", place_, fmt::format(expected, std::forward<Arguments>(arguments)...)));
    }

  private:
    std::string place_;
};

/// Has an inverse, and keeps what is parallel so.
bool is_placement(const glm::mat4& matrix) {
    const glm::vec4 last(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
    return last == glm::vec4(0, 0, 0, 1) && glm::determinant(glm::mat3(matrix)) != 0.0F;
}

// As of glTF: what makes a projection.
void check_camera(const Camera& camera, const Complaint& complain) {
    complain.require(is_placement(camera.to_world), "a matrix that has an inverse");
    if (camera.orthographic) {
        complain.require(camera.xmag > 0.0F && camera.ymag > 0.0F, "xmag and ymag above 0, got {} and {}", camera.xmag,
                         camera.ymag);
        complain.require(camera.near >= 0.0F && camera.far > camera.near, "0 <= near < far, got {} and {}", camera.near,
                         camera.far);
        return;
    }
    complain.require(camera.fovy > 0.0F && camera.fovy < std::numbers::pi_v<float>, "0 < fovy < pi, got {}",
                     camera.fovy);
    complain.require(camera.aspect >= 0.0F, "an aspect of 0 or more, got {}", camera.aspect);
    complain.require(camera.near > 0.0F && (camera.far == 0.0F || camera.far > camera.near),
                     "0 < near < far, or a far of 0, got {} and {}", camera.near, camera.far);
}

void check_light(const Light& light, const Complaint& complain) {
    constexpr float right_angle = std::numbers::pi_v<float> / 2.0F;
    complain.require(is_placement(light.to_world), "a matrix that has an inverse");
    complain.require(light.intensity >= 0.0F && light.range >= 0.0F, "intensity and range of 0 or more, got {} and {}",
                     light.intensity, light.range);
    for (int i = 0; i < 3; ++i)
        complain.require(light.colour[i] >= 0.0F, "a colour of 0 or more, got {}", light.colour[i]);
    complain.require(light.kind != LightKind::spot ||
                         (light.inner_cone >= 0.0F && light.outer_cone > 0.0F && light.inner_cone < light.outer_cone &&
                          light.outer_cone <= right_angle),
                     "0 <= inner cone < outer cone <= pi/2, got {} and {}", light.inner_cone, light.outer_cone);
}

} // namespace

void check_trace(const Trace& trace) {
    const Scene& scene = trace.scene;
    const pipeline::Resources& resources = *scene.resources;
    for (std::size_t i = 0; i < resources.geometries.size(); ++i) {
        const pipeline::VertexAttribute* const position = resources.geometries[i].find(pipeline::Semantic::position);
        // Else nothing of the file bounds the number of vertices.
        Complaint(trace, "geometry", i)
            .require(position != nullptr && position->divisor == 0, "a position of every vertex");
    }
    for (std::size_t i = 0; i < scene.draws.size(); ++i) {
        const Complaint complain(trace, "draw", i);
        complain.require(scene.draws[i].geometry < resources.geometries.size(), "one of {} geometries, got {}",
                         resources.geometries.size(), scene.draws[i].geometry);
        complain.require(scene.draws[i].material < resources.materials.size(), "one of {} materials, got {}",
                         resources.materials.size(), scene.draws[i].material);
    }
    for (std::size_t i = 0; i < scene.cameras.size(); ++i)
        check_camera(scene.cameras[i], Complaint(trace, "camera", i));
    for (std::size_t i = 0; i < scene.lights.size(); ++i) check_light(scene.lights[i], Complaint(trace, "light", i));
    if (!(scene.screen_extent.x >= 0.0F && scene.screen_extent.y >= 0.0F))
        throw sim::InputError(fmt::format("{}: screen extent: expected 0 or more", scene.name));
}

void check_finished(const Trace& trace) {
    const pipeline::Resources& resources = *trace.scene.resources;
    for (std::size_t i = 0; i < trace.scene.draws.size(); ++i) {
        const pipeline::Draw& draw = trace.scene.draws[i];
        for (const pipeline::VertexAttribute& attribute : resources.geometries[draw.geometry].attributes)
            Complaint(trace, "draw", i)
                .require(pipeline::has_elements_for(resources, attribute, draw.instances.size()),
                         "{} elements of an attribute with divisor {}",
                         (draw.instances.size() - 1) / std::max(1U, attribute.divisor) + 1, attribute.divisor);
    }
    const pipeline::View& view = trace.frame.view;
    if (view.samples != 1 && view.samples != 4 && view.samples != 8)
        throw sim::InputError(
            fmt::format("{}: captured frame: expected 1, 4 or 8 samples, got {}", trace.scene.name, view.samples));
    try {
        make_view(trace.scene, view_text(view), view.width, view.height);
    } catch (const sim::InputError& error) {
        throw sim::InputError(fmt::format("{}: captured frame: {}", trace.scene.name, error.what()));
    }
}

} // namespace traces::rtrace
