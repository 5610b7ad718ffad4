#include "traces/tetrahedra_import.hpp"

#include "traces/hash.hpp"
#include "traces/tetrahedra/tetm_reader.hpp"
#include "traces/tetrahedra/vtk_reader.hpp"

#include <cctype>

namespace traces {

namespace {

std::string extension_of(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return extension;
}

} // namespace

bool is_tetrahedra_file(const std::filesystem::path& path) {
    return extension_of(path) == ".vtk" || extension_of(path) == ".tetm";
}

Scene import_tetrahedra(const std::filesystem::path& path) {
    InputBytes file(path);
    ContentHash hash;
    hash.add_values(std::span(file.bytes().data(), file.bytes().size()));
    const bool vtk = extension_of(path) == ".vtk";
    Scene scene = scene_of(vtk ? read_vtk(std::move(file)) : read_tetm(std::move(file)));
    scene.name = path.string(); // with its folders, for errors
    scene.hash = hash.hex();
    scene.triangles = scene.resources->geometries.front().triangle_count();
    finish_scene(scene);
    scene.name = path.filename().string();
    return scene;
}

} // namespace traces
