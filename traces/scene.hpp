// A scene: what is drawn, before any rendering method is chosen.
#pragma once

#include "pipeline/draw.hpp"

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

namespace traces {

/// A camera of the scene; it looks along -z of its own frame, y is up.
struct Camera {
    std::string name;
    glm::mat4 to_world{1.0F}; ///< without scale
    bool orthographic = false;
    float fovy = 0.0F;              ///< full vertical angle in radians, perspective only
    float aspect = 0.0F;            ///< width / height of the picture it was made for; 0 = any
    float xmag = 0.0F, ymag = 0.0F; ///< half the visible width and height, orthographic only
    float near = 0.0F;
    float far = 0.0F; ///< 0 = infinite, perspective only
};

enum class LightKind : std::uint8_t { directional, point, spot };

/// A light of the scene (KHR_lights_punctual); it shines along -z of its own frame.
struct Light {
    std::string name;
    LightKind kind = LightKind::point;
    glm::mat4 to_world{1.0F};
    glm::vec3 colour{1.0F};  ///< linear RGB
    float intensity = 1.0F;  ///< candela, or lux for directional lights
    float range = 0.0F;      ///< scene units; 0 = infinite
    float inner_cone = 0.0F; ///< radians, spot lights only
    float outer_cone = 0.785398F;
};

struct Scene {
    std::string name; ///< file name, or the generator's specification
    std::string hash; ///< XXH3-64 of everything the scene was read or generated from, 16 hexadecimal digits

    std::shared_ptr<pipeline::Resources> resources; ///< placed and validated
    std::vector<pipeline::Draw> draws;              ///< in the order of the file: by node, by primitive of its mesh
    std::vector<Camera> cameras;
    std::vector<Light> lights;

    glm::vec3 lo{0.0F}, hi{0.0F}; ///< bounding box of the drawn positions in world space
    float radius = 0.0F;          ///< largest distance of a drawn position from the middle of the box

    std::uint64_t triangles = 0;       ///< of all primitives in the file, each counted once
    std::uint64_t triangles_drawn = 0; ///< of all instances of all draws
    std::uint64_t vertices = 0;        ///< of the drawn geometries, each counted once

    /// Positions are places on the screen: x to the right, y down from the top left corner, z the window depth in
    /// (0,1).
    bool screen_space = false;
    /// Scene units across and down the viewport; 0 = one unit is one pixel. Only with screen_space.
    glm::vec2 screen_extent{0.0F};

    /// Scalars of a field are its own divided by two to this power, so that a colour can hold them.
    int scalar_exponent = 0;

    std::vector<std::string> notes; ///< what of the input is not drawn or read, one line each
};

/// Reads a scene: a path to a .gltf or .glb file, `PATH#N` for its scene number N, a .vtk or .tetm file of tetrahedra,
/// what a draw trace (.rtrace) draws, or `gen:NAME?key=value&key=value`; each may be followed by `+ground`, which lays
/// a floor below it. Throws sim::InputError with one line that names file, place and what was expected.
Scene load_scene(const std::string& spec);

/// Fills bounding box and counts (all but `triangles`), places and validates the resources. For whoever makes a scene.
/// Throws sim::InputError naming scene.name when nothing is drawn or a position is not finite.
void finish_scene(Scene& scene);

} // namespace traces
