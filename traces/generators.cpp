#include "traces/generators.hpp"

#include "sim/check.hpp"
#include "sim/suggest.hpp"
#include "traces/generators/table.hpp"
#include "traces/hash.hpp"

#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <span>

namespace traces {

namespace {

const Generator& find_generator(const std::string& id) {
    std::vector<std::string> known;
    for (const Generator& one : generators()) {
        if (one.id == id) return one;
        known.push_back(one.id);
    }
    throw sim::InputError(
        fmt::format("gen:{}: expected one of {}{}", id, fmt::join(known, ", "), sim::did_you_mean(id, known)));
}

/// Attributes in the formats of the generators' defaults; others count in the hash, beside their bytes.
bool is_customary(const pipeline::VertexAttribute& attribute) {
    using pipeline::ComponentType;
    switch (slot_of(attribute.semantic)) {
    case pipeline::Slot::position:
    case pipeline::Slot::normal:
        return attribute.type == ComponentType::f32;
    case pipeline::Slot::colour:
        return attribute.semantic == pipeline::Semantic::colour && attribute.type == ComponentType::u8;
    default:
        return false;
    }
}

void add_formats(ContentHash& hash, const pipeline::Geometry& geometry) {
    for (const pipeline::VertexAttribute& attribute : geometry.attributes) {
        if (is_customary(attribute)) continue;
        const std::array<std::uint8_t, 3> format{static_cast<std::uint8_t>(attribute.semantic),
                                                 static_cast<std::uint8_t>(attribute.type), attribute.components};
        hash.add_values(std::span(format.data(), format.size()));
    }
}

std::string hash_of(const Scene& scene) {
    ContentHash hash;
    for (const pipeline::Buffer& buffer : scene.resources->buffers) hash.add(buffer.bytes);
    for (const pipeline::Draw& draw : scene.draws) {
        const pipeline::Geometry& geometry = scene.resources->geometries[draw.geometry];
        hash.add_values(std::span(&geometry.vertex_count, 1));
        hash.add_values(std::span(&geometry.index_count, 1));
        add_formats(hash, geometry);
        hash.add_values(std::span(draw.instances));
    }
    return hash.hex();
}

} // namespace

const std::vector<Generator>& generators() {
    static const std::vector<Generator> list = {
        grass_generator(),        blob_generator(),   grid_soup_generator(),  stack_generator(),     quads_generator(),
        random_quads_generator(), discs_generator(),  tetrahedra_generator(), particles_generator(), csg_generator(),
        slabs_generator(),        planes_generator(), showroom_generator()};
    return list;
}

Scene generate_scene(std::string_view spec) {
    CHECK(spec.starts_with("gen:"));
    const std::string_view rest = spec.substr(4);
    const std::size_t question = rest.find('?');
    const std::string id(rest.substr(0, question));
    const Generator& generator = find_generator(id);
    const auto text = question == std::string_view::npos ? std::string_view() : rest.substr(question + 1);

    Scene scene = generator.build(values_of_query(text, fmt::format("gen:{}", id)));
    scene.name = std::string(spec);
    for (const pipeline::Geometry& geometry : scene.resources->geometries) scene.triangles += geometry.triangle_count();
    finish_scene(scene);
    scene.hash = hash_of(scene);
    return scene;
}

} // namespace traces
