#include "traces/preparation/rebuild.hpp"

#include <fmt/format.h>
#include <memory>

namespace traces {

namespace {

/// A part among the new resources.
struct Written {
    std::uint32_t geometry = 0;
    glm::dmat4 restore{1.0};
};

std::vector<pipeline::Draw> draws_of(const pipeline::Draw& draw, const std::vector<Written>& parts) {
    std::vector<pipeline::Draw> draws;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        pipeline::Draw& part = draws.emplace_back(draw);
        part.geometry = parts[i].geometry;
        if (parts.size() > 1) part.name = fmt::format("{} part {}", draw.name, i);
        if (parts[i].restore == glm::dmat4(1.0)) continue;
        for (glm::mat4& matrix : part.instances) matrix = glm::mat4(glm::dmat4(matrix) * parts[i].restore);
    }
    return draws;
}

} // namespace

Scene rebuild_scene(Scene scene, TopologyWanted topology, const MakeParts& make) {
    auto next = std::make_shared<pipeline::Resources>();
    std::vector<std::vector<Written>> parts(scene.resources->geometries.size());
    std::vector<pipeline::Draw> draws;
    for (const pipeline::Draw& draw : scene.draws) {
        std::vector<Written>& written = parts[draw.geometry];
        if (written.empty())
            for (const PreparedPart& part :
                 make(take_mesh(*scene.resources, scene.resources->geometries[draw.geometry], topology)))
                written.push_back({write_mesh(*next, part.mesh), part.restore});
        for (pipeline::Draw& one : draws_of(draw, written)) draws.push_back(std::move(one));
    }
    const bool shared = scene.resources.use_count() > 1;
    next->textures = shared ? scene.resources->textures : std::move(scene.resources->textures);
    next->materials = scene.resources->materials;
    next->maps = shared ? scene.resources->maps : std::move(scene.resources->maps);
    next->find_runs();
    scene.resources = std::move(next);
    scene.draws = std::move(draws);
    finish_scene(scene);
    return scene;
}

Scene change_meshes(Scene scene, TopologyWanted topology, const std::function<void(TriangleMesh&)>& change) {
    return rebuild_scene(std::move(scene), topology, [&](TriangleMesh mesh) {
        change(mesh);
        std::vector<PreparedPart> parts(1);
        parts.front().mesh = std::move(mesh);
        return parts;
    });
}

} // namespace traces
