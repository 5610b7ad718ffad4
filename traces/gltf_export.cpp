#include "traces/gltf_export.hpp"

#include "sim/check.hpp"
#include "traces/gltf/export_geometry.hpp"
#include "traces/gltf/export_materials.hpp"
#include "traces/gltf/export_nodes.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <utility>

namespace traces {

namespace {

class Exporter {
  public:
    Exporter(gltf::GlbFile& file, const Scene& scene)
        : file_(file), resources_(*scene.resources), materials_(file, *scene.resources) {}

    void add_draw(const pipeline::Draw& draw) {
        if (const std::optional<std::size_t> mesh = mesh_of(draw)) gltf::export_draw(file_, draw, *mesh);
    }

  private:
    /// The mesh of a geometry with a material; accessors are shared by all meshes of one geometry.
    std::optional<std::size_t> mesh_of(const pipeline::Draw& draw) {
        const auto [entry, is_new] = meshes_.try_emplace({draw.geometry, draw.material});
        if (!is_new) return entry->second;
        const auto [primitive, is_new_geometry] = primitives_.try_emplace(draw.geometry);
        const pipeline::Geometry& geometry = resources_.geometries[draw.geometry];
        if (is_new_geometry) primitive->second = gltf::export_geometry(file_, resources_, geometry);
        if (!primitive->second) return std::nullopt;
        nlohmann::ordered_json with_material = *primitive->second;
        with_material["material"] = materials_.use(draw.material);
        nlohmann::ordered_json mesh = {{"name", geometry.name}};
        mesh["primitives"].push_back(std::move(with_material));
        entry->second = file_.add("meshes", std::move(mesh));
        return entry->second;
    }

    gltf::GlbFile& file_;
    const pipeline::Resources& resources_;
    gltf::MaterialWriter materials_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::optional<std::size_t>> meshes_; ///< by geometry, material
    std::map<std::uint32_t, std::optional<nlohmann::ordered_json>> primitives_;            ///< by geometry
};

} // namespace

std::vector<std::string> export_glb(const Scene& scene, const std::filesystem::path& path) {
    if (scene.screen_space)
        throw sim::InputError(
            fmt::format("{}: expected a scene in space to write as glTF, got places on the screen", scene.name));
    scene.resources->read_textures();
    gltf::GlbFile file;
    file.json["scene"] = 0;
    file.json["scenes"][0]["nodes"] = nlohmann::ordered_json::array();
    Exporter exporter(file, scene);
    for (const pipeline::Draw& draw : scene.draws) exporter.add_draw(draw);
    for (const Camera& camera : scene.cameras) gltf::export_camera(file, camera);
    for (const Light& light : scene.lights) gltf::export_light(file, light);
    const auto& materials = scene.resources->materials;
    if (std::any_of(materials.begin(), materials.end(),
                    [](const pipeline::Material& material) { return material.maps != pipeline::MaterialMaps{}; }))
        file.notes.emplace_back("materials are written without what they state beside colour and opacity");
    file.write(path);
    return file.notes;
}

} // namespace traces
