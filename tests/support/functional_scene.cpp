#include "tests/support/functional_scene.hpp"

#include "pipeline/functional/surface_texel.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace tests {

namespace {

template <class Element>
void add_attribute(pipeline::Resources& resources, pipeline::Geometry& geometry, pipeline::Semantic semantic,
                   const std::vector<Element>& elements) {
    if (elements.empty()) return;
    pipeline::VertexAttribute attribute;
    attribute.semantic = semantic;
    attribute.components = static_cast<std::uint8_t>(Element::length());
    attribute.buffer = static_cast<std::uint32_t>(resources.buffers.size());
    attribute.stride = sizeof(Element);
    geometry.attributes.push_back(attribute);
    resources.buffers.push_back(buffer_of(elements));
}

template <class Vector>
bool same_bytes(const Vector& a, const Vector& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

} // namespace

FunctionalScene::FunctionalScene(std::uint32_t width, std::uint32_t height) {
    view.width = width;
    view.height = height;
    view.projection[0][0] = 2.0F / static_cast<float>(width);
    view.projection[1][1] = -2.0F / static_cast<float>(height);
    view.projection[2][2] = 2.0F;
    view.projection[3] = glm::vec4(-1.0F, 1.0F, -1.0F, 1.0F);
    pipeline::Material plain;
    plain.double_sided = true;
    plain.unlit = true;
    add_material(plain);
}

std::uint32_t FunctionalScene::add(const MeshData& mesh, std::uint32_t material, const glm::mat4& model) {
    pipeline::Geometry geometry;
    geometry.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
    add_attribute(resources, geometry, pipeline::Semantic::position, mesh.positions);
    add_attribute(resources, geometry, pipeline::Semantic::normal, mesh.normals);
    add_attribute(resources, geometry, pipeline::Semantic::colour, mesh.colours);
    add_attribute(resources, geometry, pipeline::Semantic::texcoord0, mesh.texcoords);
    geometry.index_count = geometry.vertex_count;
    if (!mesh.indices.empty()) {
        geometry.index_type = pipeline::IndexType::u32;
        geometry.index_buffer = static_cast<std::uint32_t>(resources.buffers.size());
        geometry.index_count = static_cast<std::uint32_t>(mesh.indices.size());
        resources.buffers.push_back(buffer_of(mesh.indices));
    }
    resources.geometries.push_back(geometry);
    draws.push_back({"", static_cast<std::uint32_t>(resources.geometries.size() - 1), material, {model}});
    return static_cast<std::uint32_t>(draws.size() - 1);
}

std::uint32_t FunctionalScene::add_material(const pipeline::Material& material) {
    resources.materials.push_back(material);
    return static_cast<std::uint32_t>(resources.materials.size() - 1);
}

std::uint32_t FunctionalScene::add_texture(const pipeline::Texture& texture) {
    resources.textures.push_back(texture);
    return static_cast<std::uint32_t>(resources.textures.size() - 1);
}

std::vector<std::uint32_t> FunctionalScene::all_draws() const {
    std::vector<std::uint32_t> all(draws.size());
    std::iota(all.begin(), all.end(), 0U);
    return all;
}

pipeline::FragmentStream FunctionalScene::rasterize(const pipeline::FrontEndOptions& options) {
    resources.place();
    const bool programs =
        std::any_of(draws.begin(), draws.end(), [](const auto& draw) { return draw.program != nullptr; });
    resources.validate("scene", programs ? pipeline::Positions::computed : pipeline::Positions::attribute);
    return pipeline::rasterize(resources, draws, all_draws(), view, options);
}

void bind_surfaces(pipeline::Frame& frame) {
    pipeline::SurfaceInfo depth{.name = "depth", .format = frame.depth_format};
    pack_depth_stencil(depth.format, {farthest_depth(depth.format), 0}, depth.cleared.data());
    pipeline::SurfaceInfo colour{.name = "colour", .format = frame.colour_format};
    pack_colour(colour.format, frame.background, colour.cleared.data());
    frame.surfaces = {depth, colour};
    if (frame.program != nullptr) frame.surfaces.push_back({.name = "kbuffer", .program = frame.program});
    for (pipeline::SurfaceInfo& surface : frame.surfaces) {
        surface.width = frame.view.width;
        surface.height = frame.view.height;
        surface.planes = frame.view.samples;
    }
    for (pipeline::Pass& pass : frame.passes) pass.depth = pass.uses_depth() ? depth_surface : pipeline::no_surface;
}

pipeline::Buffer buffer_of(const void* data, std::size_t bytes) {
    pipeline::Buffer buffer;
    buffer.bytes.resize(bytes);
    if (bytes != 0) std::memcpy(buffer.bytes.data(), data, bytes);
    return buffer;
}

pipeline::Texture texture_of(std::uint32_t width, std::uint32_t height, const std::vector<std::uint32_t>& rgba_codes) {
    pipeline::Texture texture;
    texture.levels.resize(1);
    texture.levels[0].width = width;
    texture.levels[0].height = height;
    for (const std::uint32_t code : rgba_codes)
        for (const unsigned shift : {24U, 16U, 8U, 0U})
            texture.levels[0].rgba.push_back(static_cast<std::uint8_t>(code >> shift));
    return texture;
}

pipeline::Texture texture_of_one_colour(std::uint32_t width, std::uint32_t height, std::uint32_t rgba_code) {
    return texture_of(width, height, std::vector<std::uint32_t>(std::size_t{width} * height, rgba_code));
}

std::vector<std::uint32_t> coverage_counts(const pipeline::FragmentStream& stream) {
    std::vector<std::uint32_t> counts(std::size_t{stream.width} * stream.height);
    for (const pipeline::Quad& quad : stream.quads)
        for (std::size_t lane = 0; lane < 4; ++lane)
            if (((quad.covered >> lane) & 1U) != 0) ++counts.at((quad.y + lane / 2) * stream.width + quad.x + lane % 2);
    return counts;
}

MeshData rectangle(float x0, float y0, float x1, float y1, float depth) {
    MeshData mesh;
    mesh.positions = {{x0, y0, depth}, {x1, y0, depth}, {x0, y1, depth}, {x1, y1, depth}};
    mesh.texcoords = {{0.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F}, {1.0F, 1.0F}};
    mesh.indices = {0, 1, 2, 2, 1, 3};
    return mesh;
}

bool equal(const pipeline::FragmentStream& a, const pipeline::FragmentStream& b) {
    // Primitive and Triangle have padding bytes, which have no value.
    const auto same_primitives = [&] {
        if (a.primitives.size() != b.primitives.size()) return false;
        for (std::size_t i = 0; i < a.primitives.size(); ++i) {
            const pipeline::Primitive &p = a.primitives[i], &q = b.primitives[i];
            if (p.first_triangle != q.first_triangle || p.triangles != q.triangles || p.fate != q.fate ||
                p.clipped != q.clipped)
                return false;
        }
        return true;
    };
    const auto same_triangle = [](const pipeline::Triangle& p, const pipeline::Triangle& q) {
        return p.draw == q.draw && p.primitive == q.primitive && p.first_quad == q.first_quad && p.quads == q.quads &&
               p.tiles == q.tiles && p.front == q.front;
    };
    return a.width == b.width && a.height == b.height && same_bytes(a.draws, b.draws) && same_primitives() &&
           std::equal(a.triangles.begin(), a.triangles.end(), b.triangles.begin(), b.triangles.end(), same_triangle) &&
           same_bytes(a.quads, b.quads) && same_bytes(a.depths, b.depths) && same_bytes(a.colours, b.colours) &&
           same_bytes(a.texture_lines, b.texture_lines) && a.fragments == b.fragments &&
           a.fragments_discarded == b.fragments_discarded;
}

} // namespace tests
