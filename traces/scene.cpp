#include "traces/scene.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"
#include "traces/generators.hpp"
#include "traces/gltf_import.hpp"
#include "traces/ground.hpp"
#include "traces/scene_bounds.hpp"
#include "traces/tetrahedra_import.hpp"
#include "traces/trace.hpp"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace traces {

namespace {

Scene scene_of_trace(const std::string& path) {
    Trace trace = read_trace(path);
    if (trace.recording)
        throw sim::InputError(fmt::format("{}: expected a scene, got frames that an application drew", path));
    return std::move(trace.scene);
}

void check_draws(const Scene& scene) {
    for (const pipeline::Draw& draw : scene.draws) {
        CHECK(draw.geometry < scene.resources->geometries.size());
        CHECK(draw.material < scene.resources->materials.size());
        CHECK(!draw.instances.empty());
    }
}

bool is_finite(const glm::vec4& value) {
    return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z) && std::isfinite(value.w);
}

// What is no number here would become the colour of fragments. Readers check materials; textures hold whole numbers,
// and texture coordinates are bounded where they are used.
void check_colours(const Scene& scene) {
    for (const pipeline::Geometry& geometry : scene.resources->geometries) {
        const pipeline::VertexAttribute* const colours = geometry.find(pipeline::Semantic::colour);
        if (colours == nullptr ||
            (colours->type != pipeline::ComponentType::f32 && colours->type != pipeline::ComponentType::f16))
            continue;
        const pipeline::AttributeReader read(*scene.resources, *colours);
        for (std::uint32_t i = 0; i < geometry.vertex_count; ++i)
            if (!is_finite(read(i)))
                throw sim::InputError(
                    fmt::format("{}: {}: colour {}: expected finite numbers", scene.name, geometry.name, i));
    }
}

} // namespace

void finish_scene(Scene& scene) {
    check_draws(scene);
    scene.resources->validate(scene.name);
    check_colours(scene);
    scene.resources->place();
    scene.triangles_drawn = 0;
    scene.vertices = 0;
    for (const pipeline::Draw& draw : scene.draws)
        scene.triangles_drawn +=
            std::uint64_t{scene.resources->geometries[draw.geometry].triangle_count()} * draw.instances.size();
    for (const pipeline::Geometry& geometry : scene.resources->geometries) scene.vertices += geometry.vertex_count;
    if (scene.triangles_drawn == 0)
        throw sim::InputError(fmt::format("{}: expected at least one triangle to draw", scene.name));
    const Bounds bounds = measure_bounds(scene);
    scene.lo = bounds.lo;
    scene.hi = bounds.hi;
    scene.radius = bounds.radius;
}

Scene load_scene(const std::string& spec) {
    constexpr std::string_view ground = "+ground";
    if (spec.ends_with(ground)) {
        Scene scene = load_scene(spec.substr(0, spec.size() - ground.size()));
        add_ground(scene);
        return scene;
    }
    if (spec.starts_with("gen:")) return generate_scene(spec);
    if (is_tetrahedra_file(spec)) return import_tetrahedra(spec);
    if (is_trace_file(spec)) return scene_of_trace(spec);
    const std::size_t hash = spec.rfind('#');
    std::error_code error; // a file whose own name has a '#' is that file
    if (hash == std::string::npos || std::filesystem::exists(spec, error)) return import_gltf(spec);
    return import_gltf(spec.substr(0, hash), spec.substr(hash + 1));
}

} // namespace traces
