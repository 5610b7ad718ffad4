#include "traces/rtrace/records.hpp"

#include "traces/rtrace/codes.hpp"

#include <fmt/format.h>

namespace traces::rtrace {

namespace {

using pipeline::ComponentType;
using pipeline::Topology;

// The codes of the file: new ones go to the end.
constexpr std::array<Code<Topology>, 7> topologies{{{Topology::triangles, "triangles"},
                                                    {Topology::triangle_strip, "triangle strip"},
                                                    {Topology::triangle_fan, "triangle fan"},
                                                    {Topology::points, "points"},
                                                    {Topology::lines, "lines"},
                                                    {Topology::line_strip, "line strip"},
                                                    {Topology::line_loop, "line loop"}}};
constexpr std::array<Code<pipeline::IndexType>, 4> index_types{{{pipeline::IndexType::none, "none"},
                                                                {pipeline::IndexType::u8, "u8"},
                                                                {pipeline::IndexType::u16, "u16"},
                                                                {pipeline::IndexType::u32, "u32"}}};
constexpr std::array<Code<ComponentType>, 9> component_types{{{ComponentType::f32, "f32"},
                                                              {ComponentType::f16, "f16"},
                                                              {ComponentType::s8, "s8"},
                                                              {ComponentType::u8, "u8"},
                                                              {ComponentType::s16, "s16"},
                                                              {ComponentType::u16, "u16"},
                                                              {ComponentType::u32, "u32"},
                                                              {ComponentType::s10_10_10_2, "s10_10_10_2"},
                                                              {ComponentType::u10_10_10_2, "u10_10_10_2"}}};
enum class TexelFormat : std::uint8_t { rgba8 };
constexpr std::array<Code<TexelFormat>, 1> texel_formats{{{TexelFormat::rgba8, "rgba8"}}};
constexpr std::array<Code<pipeline::AlphaMode>, 3> alpha_modes{{{pipeline::AlphaMode::opaque, "opaque"},
                                                                {pipeline::AlphaMode::mask, "mask"},
                                                                {pipeline::AlphaMode::blend, "blend"}}};
constexpr std::array<Code<LightKind>, 3> light_kinds{
    {{LightKind::directional, "directional"}, {LightKind::point, "point"}, {LightKind::spot, "spot"}}};

void visit_texts(Fields& fields, std::string_view kind, std::vector<std::string>& texts) {
    fields.list(kind, texts, 4, [&](std::string& text, std::size_t) { fields.text("text", text); });
}

void visit_metadata(Fields& fields, Document& document) {
    TraceMetadata& metadata = document.trace.metadata;
    fields.text("writer", metadata.writer);
    fields.text("name", metadata.name);
    fields.text("licence", metadata.licence);
    fields.text("scene", metadata.scene);
    fields.text("scene hash", metadata.scene_hash);
}

void visit_scene(Fields& fields, Document& document) {
    Scene& scene = document.trace.scene;
    fields.whole("triangles", scene.triangles);
    fields.flag("screen space", scene.screen_space);
    fields.vector("screen extent", scene.screen_extent);
    fields.integer("scalar exponent", scene.scalar_exponent, -1024, 1024);
    visit_texts(fields, "scene note", scene.notes);
}

void visit_buffers(Fields& fields, Document& document) {
    auto& buffers = document.trace.scene.resources->buffers;
    fields.list("buffer", buffers, 28, [&](pipeline::Buffer& buffer, std::size_t i) {
        fields.text("name", buffer.name);
        fields.blob("bytes", document.blobs[{Place::Kind::buffer, i, 0}]);
    });
}

void visit_geometries(Fields& fields, Document& document) {
    auto& geometries = document.trace.scene.resources->geometries;
    fields.list("geometry", geometries, 31, [&](pipeline::Geometry& geometry, std::size_t) {
        fields.text("name", geometry.name);
        fields.choice("topology", geometry.topology, topologies);
        fields.whole("vertices", geometry.vertex_count);
        fields.choice("index type", geometry.index_type, index_types);
        fields.whole("index buffer", geometry.index_buffer);
        fields.whole("index offset", geometry.index_offset);
        fields.whole("indices", geometry.index_count);
        fields.flag("primitive restart", geometry.primitive_restart);
        fields.list("attribute", geometry.attributes, 24, [&](pipeline::VertexAttribute& attribute, std::size_t) {
            fields.choice("semantic", attribute.semantic, attribute_semantics);
            fields.choice("type", attribute.type, component_types);
            fields.whole<std::uint8_t>("components", attribute.components, 1, 4);
            fields.flag("normalized", attribute.normalized);
            fields.whole("buffer", attribute.buffer);
            fields.whole("offset", attribute.offset);
            fields.whole("stride", attribute.stride);
            fields.whole("divisor", attribute.divisor);
        });
    });
}

void visit_texture(Fields& fields, Document& document, pipeline::Texture& texture, Place::Kind kind, std::size_t i) {
    TexelFormat format = TexelFormat::rgba8;
    fields.text("name", texture.name);
    fields.choice("format", format, texel_formats);
    fields.flag("sRGB", texture.srgb);
    fields.choice("wrap u", texture.wrap_u, wraps);
    fields.choice("wrap v", texture.wrap_v, wraps);
    fields.choice("minification", texture.min_filter, filters);
    fields.choice("magnification", texture.mag_filter, filters);
    fields.vector("border", texture.border);
    fields.list("level", texture.levels, 32, [&](pipeline::Texture::Level& level, std::size_t k) {
        fields.whole("width", level.width);
        fields.whole("height", level.height);
        fields.blob("texels", document.blobs[{kind, i, k}]);
    });
}

void visit_textures(Fields& fields, Document& document) {
    auto& textures = document.trace.scene.resources->textures;
    fields.list("texture", textures, 30, [&](pipeline::Texture& texture, std::size_t i) {
        visit_texture(fields, document, texture, Place::Kind::texture_level, i);
    });
}

void visit_map(Fields& fields, std::string_view name, pipeline::MaterialMap& map) {
    fields.part(name, [&] {
        fields.integer("map", map.texture, -1, INT32_MAX);
        fields.whole("texcoord", map.texcoord);
        fields.matrix("uv transform", map.uv_transform);
    });
}

void visit_maps(Fields& fields, Document& document) {
    auto& textures = document.trace.scene.resources->maps;
    fields.list("map", textures, 30, [&](pipeline::LateTexture& map, std::size_t i) {
        visit_texture(fields, document, map.texture, Place::Kind::map_level, i);
    });
    fields.list("maps of material", document.maps, 196, [&](NumberedMaps& of, std::size_t) {
        fields.whole("material", of.material);
        visit_map(fields, "normal", of.maps.normal);
        visit_map(fields, "roughness", of.maps.roughness);
        visit_map(fields, "specular", of.maps.specular);
        visit_map(fields, "emissive", of.maps.emissive);
        fields.number("normal scale", of.maps.normal_scale);
        fields.number("metallic factor", of.maps.metallic_factor);
        fields.number("roughness factor", of.maps.roughness_factor);
        fields.number("specular factor", of.maps.specular_factor);
        fields.vector("emissive factor", of.maps.emissive_factor);
    });
}

bool has_maps(const Document& document) { return !document.maps.empty(); }

void visit_materials(Fields& fields, Document& document) {
    auto& materials = document.trace.scene.resources->materials;
    fields.list("material", materials, 73, [&](pipeline::Material& material, std::size_t) {
        fields.text("name", material.name);
        fields.vector("base colour", material.base_colour);
        fields.integer("base texture", material.base_texture, -1, INT32_MAX);
        fields.whole("texcoord", material.texcoord);
        fields.matrix("uv transform", material.uv_transform);
        fields.choice("alpha mode", material.alpha_mode, alpha_modes);
        fields.number("alpha cutoff", material.alpha_cutoff);
        fields.flag("double sided", material.double_sided);
        fields.number("transmission", material.transmission);
        fields.flag("unlit", material.unlit);
        fields.flag("flat", material.flat);
    });
}

void visit_draws(Fields& fields, Document& document) {
    auto& draws = document.trace.scene.draws;
    fields.list("draw", draws, 40, [&](pipeline::Draw& draw, std::size_t i) {
        document.instance_counts.resize(draws.size());
        std::uint32_t& count = document.instance_counts[i];
        fields.text("name", draw.name);
        fields.whole("geometry", draw.geometry);
        fields.whole("material", draw.material);
        fields.whole<std::uint32_t>("instances", count, 1);
        if (count > most_matrices_in_record) {
            fields.blob("matrices", document.blobs[{Place::Kind::instances, i, 0}]);
            return;
        }
        draw.instances.resize(count);
        for (glm::mat4& matrix : draw.instances) fields.matrix("matrix", matrix);
    });
}

void visit_cameras(Fields& fields, Document& document) {
    fields.list("camera", document.trace.scene.cameras, 93, [&](Camera& camera, std::size_t) {
        fields.text("name", camera.name);
        fields.matrix("to world", camera.to_world);
        fields.flag("orthographic", camera.orthographic);
        fields.number("fovy", camera.fovy);
        fields.number("aspect", camera.aspect);
        fields.number("xmag", camera.xmag);
        fields.number("ymag", camera.ymag);
        fields.number("near", camera.near);
        fields.number("far", camera.far);
    });
}

void visit_lights(Fields& fields, Document& document) {
    fields.list("light", document.trace.scene.lights, 97, [&](Light& light, std::size_t) {
        fields.text("name", light.name);
        fields.choice("kind", light.kind, light_kinds);
        fields.matrix("to world", light.to_world);
        fields.vector("colour", light.colour);
        fields.number("intensity", light.intensity);
        fields.number("range", light.range);
        fields.number("inner cone", light.inner_cone);
        fields.number("outer cone", light.outer_cone);
    });
}

void visit_captured(Fields& fields, Document& document) {
    CapturedFrame& frame = document.trace.frame;
    fields.text("camera", frame.camera);
    fields.matrix("view", frame.view.view);
    fields.matrix("projection", frame.view.projection);
    fields.whole("width", frame.view.width, 1U, 16384U);
    fields.whole("height", frame.view.height, 1U, 16384U);
    fields.whole("samples", frame.view.samples, 1U, 8U);
    fields.text("workload", frame.workload);
    fields.text("options", frame.options);
    fields.text("parameters", frame.parameters);
    visit_texts(fields, "frame note", frame.notes);
}

using Of = Record::Of;
constexpr std::array<Record, 21> all{{{Of::both, chunk::metadata, visit_metadata},
                                      {Of::captured, chunk::scene, visit_scene},
                                      {Of::both, chunk::buffers, visit_buffers},
                                      {Of::both, chunk::geometries, visit_geometries},
                                      {Of::captured, chunk::textures, visit_textures},
                                      {Of::captured, chunk::materials, visit_materials},
                                      {Of::captured, chunk::draws, visit_draws},
                                      {Of::captured, chunk::cameras, visit_cameras},
                                      {Of::captured, chunk::lights, visit_lights},
                                      {Of::captured, chunk::captured, visit_captured},
                                      {Of::captured, chunk::maps, visit_maps, has_maps},
                                      {Of::recorded, chunk::surfaces, visit_surfaces},
                                      {Of::recorded, chunk::samplers, visit_samplers},
                                      {Of::recorded, chunk::programs, visit_programs},
                                      {Of::recorded, chunk::values, visit_values},
                                      {Of::recorded, chunk::bindings, visit_bindings},
                                      {Of::recorded, chunk::states, visit_states},
                                      {Of::recorded, chunk::depth_ranges, visit_depth_ranges, has_depth_ranges},
                                      {Of::recorded, chunk::targets, visit_targets},
                                      {Of::recorded, chunk::frames, visit_frames},
                                      {Of::recorded, chunk::not_recorded, visit_not_recorded}}};

} // namespace

std::span<const Record> records() { return all; }

std::string Place::text() const {
    switch (kind) {
    case Kind::buffer:
        return fmt::format("buffer {}", i);
    case Kind::texture_level:
        return fmt::format("texture {} level {}", i, level);
    case Kind::map_level:
        return fmt::format("map {} level {}", i, level);
    case Kind::instances:
        return fmt::format("the matrices of draw {}", i);
    case Kind::surface_level:
        return fmt::format("surface {} level {}", i, level);
    case Kind::vertex_module:
        return fmt::format("the vertex shader of program {}", i);
    case Kind::fragment_module:
        return fmt::format("the fragment shader of program {}", i);
    case Kind::uniform:
        break;
    }
    return fmt::format("values {} uniform {}", i, level);
}

ChunkType Place::named_in() const {
    switch (kind) {
    case Kind::buffer:
        return chunk::buffers;
    case Kind::texture_level:
        return chunk::textures;
    case Kind::map_level:
        return chunk::maps;
    case Kind::instances:
        return chunk::draws;
    case Kind::surface_level:
        return chunk::surfaces;
    case Kind::vertex_module:
    case Kind::fragment_module:
        return chunk::programs;
    case Kind::uniform:
        break;
    }
    return chunk::values;
}

} // namespace traces::rtrace
