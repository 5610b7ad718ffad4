#include "tests/support/recordings.hpp"

#include "tests/support/spirv_assembler.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

namespace support {

namespace {

using tests::SpirvAssembler;
using traces::SurfaceKind;
using traces::spirv::Op;
using traces::spirv::Storage;
using Id = SpirvAssembler::Id;

constexpr std::uint32_t window_width = 16, window_height = 12;

template <class T>
std::vector<std::byte> bytes_of_values(const std::vector<T>& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return {bytes.begin(), bytes.end()};
}

std::vector<std::uint32_t> words_of_values(const std::vector<float>& values) {
    std::vector<std::uint32_t> words;
    for (const float value : values) words.push_back(std::bit_cast<std::uint32_t>(value));
    return words;
}

/// Bytes that follow from a number.
std::vector<std::byte> pattern(std::uint64_t bytes, std::uint32_t number) {
    std::vector<std::byte> result(bytes);
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = static_cast<std::byte>(i * 37 + number * 101 + 11);
    return result;
}

/// With contents in all levels.
traces::RecordedSurface full_surface(const std::string& name, SurfaceKind kind, pipeline::SurfaceFormat format,
                                     std::array<std::uint32_t, 3> size, std::uint32_t levels, std::uint32_t number) {
    traces::RecordedSurface surface;
    surface.name = name;
    surface.kind = kind;
    surface.format = format;
    surface.width = size[0];
    surface.height = size[1];
    surface.depth = size[2];
    surface.levels.resize(levels);
    for (std::uint32_t level = 0; level < levels; ++level)
        surface.levels[level] = pattern(level_bytes(surface, level), number + level);
    return surface;
}

traces::RecordedSurface empty_surface(const std::string& name, pipeline::SurfaceFormat format, std::uint32_t width,
                                      std::uint32_t height, std::uint32_t samples = 1) {
    traces::RecordedSurface surface;
    surface.name = name;
    surface.format = format;
    surface.width = width;
    surface.height = height;
    surface.samples = samples;
    return surface;
}

traces::TargetSet window_targets() {
    traces::TargetSet set;
    set.colours = {traces::TargetSet::Target{0, 0, 0}};
    set.depth = traces::TargetSet::Target{1, 0, 0};
    set.width = window_width;
    set.height = window_height;
    return set;
}

/// The n-th of an enumeration, from the first again behind its last.
template <class E>
E nth(std::uint32_t n, std::uint32_t count) {
    return static_cast<E>(n % count);
}

pipeline::RasterState state_number(std::uint32_t n) {
    using pipeline::Compare;
    using pipeline::StencilOperation;
    pipeline::RasterState state;
    const auto part = [&](std::uint32_t i) {
        return pipeline::BlendPart{nth<pipeline::BlendFactor>(n + i, 15), nth<pipeline::BlendFactor>(n + i + 4, 15),
                                   nth<pipeline::BlendEquation>(n + i, 5)};
    };
    const auto face = [&](std::uint32_t i) {
        return pipeline::StencilFace{nth<Compare>(n + i, 8),
                                     static_cast<std::uint8_t>(n),
                                     static_cast<std::uint8_t>(255 - n),
                                     static_cast<std::uint8_t>(3 * n),
                                     nth<StencilOperation>(n + i, 8),
                                     nth<StencilOperation>(n + i + 1, 8),
                                     nth<StencilOperation>(n + i + 2, 8)};
    };
    for (std::uint32_t i = 0; i <= n % 8; ++i) {
        state.blend[i] = {i % 2 == 0, part(i), part(i + 1), {0.25F, 0.5F, -1.0F, 2.0F}};
        state.write_mask[i] = static_cast<std::uint8_t>((n + i) % 16);
    }
    state.depth = {n % 2 == 0, n % 3 == 0, nth<Compare>(n, 8), n % 4 == 0, 1.5F, -2.0F};
    state.stencil = {n % 2 == 1, face(0), face(3)};
    if (n % 2 == 1) state.viewport = pipeline::PixelRectangle{-3, 2, 14, 10};
    if (n % 3 == 1) state.scissor = pipeline::PixelRectangle{1, -1, 5, 100};
    state.culling = nth<pipeline::FaceCulling>(n, 5);
    state.front_is_clockwise = n % 2 == 0;
    state.provoking = nth<pipeline::ProvokingVertex>(n, 2);
    state.point_size = 2.5F;
    state.point_size_of_vertex = n % 2 == 0;
    state.point_sprites = n % 3 == 0;
    state.line_width = 3.0F;
    state.clip_planes = static_cast<std::uint8_t>(1U << n % 8);
    state.clip_plane[n % 8] = {0.0F, 1.0F, -0.5F, static_cast<float>(n)};
    return state;
}

void add_geometries(pipeline::Resources& resources) {
    using pipeline::ComponentType;
    using pipeline::IndexType;
    using pipeline::Semantic;
    const std::vector<float> instance_places{0, 0, 0, 1, 0.5F, 0, 0, 1, 0, 0.5F, 0, 1};
    const auto first = static_cast<std::uint32_t>(resources.buffers.size());
    resources.buffers.push_back({"anything", pattern(400, 1), 0});
    resources.buffers.push_back({"anything again", pattern(400, 1), 0});
    resources.buffers.push_back({"instances", bytes_of_values(instance_places), 0});
    resources.buffers.push_back({"restarted", bytes_of_values<std::uint16_t>({0, 1, 2, 0xFFFF, 1, 3, 2}), 0});
    resources.buffers.push_back({"u8", bytes_of_values<std::uint8_t>({0, 1, 2}), 0});
    resources.buffers.push_back({"u32", bytes_of_values<std::uint32_t>({7, 2, 1, 0}), 0});
    pipeline::Geometry geometry;
    geometry.name = "instances";
    geometry.vertex_count = 4;
    geometry.index_count = 3;
    geometry.attributes = {{Semantic::position, ComponentType::f32, 4, false, first + 2, 0, 16, 1},
                           {Semantic::generic3, ComponentType::f32, 3, false, 0, 0, 12, 0}};
    resources.geometries.push_back(geometry);
    geometry = {};
    geometry.name = "by vertex number alone";
    geometry.vertex_count = geometry.index_count = 3;
    resources.geometries.push_back(geometry);
    geometry.name = "restarted";
    geometry.topology = pipeline::Topology::triangle_strip;
    geometry.vertex_count = 4;
    geometry.index_type = IndexType::u16;
    geometry.index_buffer = first + 3;
    geometry.index_count = 7;
    geometry.primitive_restart = true;
    geometry.attributes = {{Semantic::position, ComponentType::f32, 3, false, 0, 0, 12, 0}};
    resources.geometries.push_back(geometry);
    geometry.primitive_restart = false;
    for (std::uint32_t i = 0; i < 7; ++i) { // topologies
        geometry.name = "topology " + std::to_string(i);
        geometry.topology = nth<pipeline::Topology>(i, 7);
        geometry.index_type = i % 2 == 0 ? IndexType::u8 : IndexType::u32;
        geometry.index_buffer = first + (i % 2 == 0 ? 4 : 5);
        geometry.index_offset = i % 2 == 0 ? 0 : 4;
        geometry.index_count = 3;
        resources.geometries.push_back(geometry);
    }
    geometry.name = "component types and generic attributes";
    geometry.attributes.clear();
    for (std::uint32_t i = 0; i < pipeline::semantics; ++i) {
        const auto type = nth<ComponentType>(i, 9);
        const auto components = static_cast<std::uint8_t>(pipeline::is_packed(type) ? 4 : 1 + i % 4);
        geometry.attributes.push_back({nth<Semantic>(i, pipeline::semantics), type, components, i % 2 == 1,
                                       first + i % 2, i, pipeline::element_bytes(type, components) + i, 0});
    }
    resources.geometries.push_back(geometry);
}

void add_surfaces(traces::Recording& recording) {
    using pipeline::SurfaceFormat;
    recording.surfaces.push_back(full_surface("layers", SurfaceKind::layers, SurfaceFormat::rgba8, {5, 4, 3}, 2, 40));
    recording.surfaces.push_back(
        full_surface("W\xC3\xBCrfel", SurfaceKind::cube, SurfaceFormat::rgba8, {4, 4, 1}, 3, 40));
    recording.surfaces.push_back(full_surface("volume", SurfaceKind::volume, SurfaceFormat::r8, {4, 2, 4}, 3, 50));
    recording.surfaces.push_back(full_surface("bones", SurfaceKind::buffer, SurfaceFormat::r32f, {10, 1, 1}, 1, 60));
    recording.surfaces.push_back(
        full_surface("bones again", SurfaceKind::buffer, SurfaceFormat::r32f, {10, 1, 1}, 1, 60));
    recording.surfaces.push_back(empty_surface("four samples", SurfaceFormat::rgba8, window_width, window_height, 4));
    recording.surfaces.push_back(empty_surface("shadow", SurfaceFormat::d32f, 8, 8));
    recording.surfaces.push_back(
        full_surface("half there", SurfaceKind::plane, SurfaceFormat::rgba8, {16, 16, 1}, 5, 70));
    recording.surfaces.back().levels[3] = {};
    for (std::uint32_t i = 0; i < pipeline::surface_formats.size(); ++i)
        recording.surfaces.push_back(full_surface("format " + std::to_string(i), SurfaceKind::plane,
                                                  static_cast<SurfaceFormat>(i), {2, 1, 1}, 1, i));
}

void add_bindings(traces::Recording& recording, std::uint32_t cube) {
    using traces::Swizzle;
    for (std::uint32_t i = 0; i < 8; ++i) {
        traces::RecordedSampler sampler;
        sampler.wrap_u = nth<pipeline::Wrap>(i, 4);
        sampler.wrap_v = nth<pipeline::Wrap>(i + 1, 4);
        sampler.wrap_w = nth<pipeline::Wrap>(i + 2, 4);
        sampler.min_filter = nth<pipeline::Filter>(i, 6);
        sampler.mag_filter = nth<pipeline::Filter>(i, 2);
        sampler.border = {0.125F, -1.0F, 3.0F, 1.0F};
        sampler.lod_bias = 0.5F;
        sampler.least_lod = -1.0F;
        sampler.most_lod = 3.0F;
        sampler.anisotropy = 1.0F + static_cast<float>(i);
        sampler.compares = i % 2 == 0;
        sampler.compare = nth<pipeline::Compare>(i, 8);
        sampler.seamless = i % 3 == 0;
        recording.samplers.push_back(sampler);
    }
    traces::TextureBinding first{"sky", 0, cube, 3, {Swizzle::zero, Swizzle::one, Swizzle::alpha, Swizzle::red}, 1, 2};
    traces::TextureBinding second{"sky", 1, 2, 8, {Swizzle::green, Swizzle::blue, Swizzle::red, Swizzle::one}, 0, 1000};
    recording.bindings.push_back({first, second});
    recording.bindings.emplace_back();
}

traces::RecordedDraw draw_of(const std::string& name, std::uint32_t geometry) {
    traces::RecordedDraw draw;
    draw.name = name;
    draw.geometry = geometry;
    draw.fragment_values = 1;
    return draw;
}

std::vector<traces::RecordedCommand> commands_of_everything(const traces::Recording& recording, std::uint32_t layers) {
    std::vector<traces::RecordedCommand> commands;
    const auto geometries = static_cast<std::uint32_t>(recording.resources->geometries.size());
    const auto states = static_cast<std::uint32_t>(recording.states.size());
    for (std::uint32_t i = 0; i < std::max(geometries, states); ++i) {
        traces::RecordedDraw draw = draw_of("draw " + std::to_string(i), i % geometries);
        draw.instances = 1 + i % 3;
        draw.first_instance = i;
        draw.base_vertex = -static_cast<std::int32_t>(i);
        draw.targets = i % 3;
        draw.program = i % 2;
        draw.vertex_values = i % 4;
        draw.bindings = i % 3;
        draw.state = i % states;
        draw.alpha_test = nth<pipeline::Compare>(i, 8);
        draw.alpha_reference = 0.5F;
        for (std::uint32_t k = 0; k < i % 3; ++k)
            draw.constants.push_back({"constant" + std::to_string(k), {1.0F, 2.0F, 3.0F, static_cast<float>(k)}});
        commands.emplace_back(draw);
    }
    traces::RecordedClear clear;
    clear.name = "under masks";
    clear.colours = 1;
    clear.colour = {1.0F, 0.5F, 0.25F, 0.0F};
    clear.write_mask = {7, 15, 1, 15, 15, 15, 15, 15};
    clear.stencil = std::uint8_t{200};
    clear.stencil_mask = 0x0F;
    clear.scissor = pipeline::PixelRectangle{-2, 3, 5, 6};
    commands.emplace_back(clear);
    commands.emplace_back(traces::RecordedCopy{"window to layer", {0, 0, 0}, {layers, 0, 2}, {3, 2, 4, 3}, 1, 1});
    return commands;
}

} // namespace

std::vector<std::uint32_t> transforming_shader() {
    SpirvAssembler a;
    const Id v4 = a.vector(a.real(), 4), matrix = a.matrix(4, 4);
    const Id position = a.input(v4, 0), transform = a.uniform(matrix, "transform");
    a.name(position, "position");
    const Id placed = a.result(Op::matrix_times_vector, v4, {a.load(transform, matrix), a.load(position, v4)});
    a.store(a.built_in(Storage::output, v4, 0), placed); // SPIR-V specification, section 3.21: Position
    return a.vertex_module();
}

std::vector<std::uint32_t> tinting_shader() {
    SpirvAssembler a;
    constexpr std::uint32_t two_dimensions = 1;
    const Id v4 = a.vector(a.real(), 4), type = a.sampled_image(two_dimensions);
    const Id half = a.constant(0.5F), place = a.composite(a.vector(a.real(), 2), {half, half});
    const Id texels = a.result(Op::image_sample_implicit_lod, v4, {a.load(a.uniform(type, "image"), type), place});
    a.store(a.output(v4, 0), a.result(Op::f_mul, v4, {texels, a.load(a.uniform(v4, "tint"), v4)}));
    return a.module();
}

traces::Recording quad_recording() {
    traces::Recording recording;
    recording.resources = std::make_shared<pipeline::Resources>();
    pipeline::Resources& resources = *recording.resources;
    resources.buffers = {
        {"corners", bytes_of_values<float>({-0.5F, -0.5F, 0, 0.5F, -0.5F, 0, -0.5F, 0.5F, 0, 0.5F, 0.5F, 0}), 0},
        {"indices", bytes_of_values<std::uint16_t>({0, 1, 2, 2, 1, 3}), 0}};
    pipeline::Geometry quad;
    quad.name = "quad";
    quad.vertex_count = 4;
    quad.index_type = pipeline::IndexType::u16;
    quad.index_buffer = 1;
    quad.index_count = 6;
    quad.attributes = {{pipeline::Semantic::position, pipeline::ComponentType::f32, 3, false, 0, 0, 12, 0}};
    resources.geometries = {quad};
    recording.surfaces = {empty_surface("window", pipeline::SurfaceFormat::rgba8, window_width, window_height),
                          empty_surface("window's depth", pipeline::SurfaceFormat::d24s8, window_width, window_height),
                          full_surface("image", SurfaceKind::plane, pipeline::SurfaceFormat::rgba8, {4, 2, 1}, 3, 30)};
    recording.samplers.resize(1);
    recording.programs = {{"tinted", transforming_shader(), tinting_shader(), {{"position", 0}}}};
    recording.values = {{{"transform", words_of_values({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1})}},
                        {{"tint", words_of_values({1, 0.5F, 0.25F, 1})}}};
    recording.bindings = {{{"image", 0, 2, 0}}};
    recording.states.resize(1);
    recording.states[0].depth.test = recording.states[0].depth.write = true;
    recording.states[0].culling = pipeline::FaceCulling::none;
    recording.targets = {window_targets()};
    traces::RecordedClear clear;
    clear.name = "all";
    clear.colours = 1;
    clear.colour = {0.0F, 0.0F, 1.0F, 1.0F};
    clear.depth = 1.0F;
    clear.stencil = std::uint8_t{0};
    recording.frames = {{0, 0, {clear, draw_of("quad", 0)}}};
    return recording;
}

traces::Recording rich_recording() {
    traces::Recording recording = quad_recording();
    add_geometries(*recording.resources);
    recording.resources->find_runs();
    const auto layers = static_cast<std::uint32_t>(recording.surfaces.size()), cube = layers + 1, shadow = layers + 6;
    add_surfaces(recording);
    add_bindings(recording, cube);
    for (std::uint32_t i = 0; i < 16; ++i) recording.states.push_back(state_number(i));
    traces::RecordedProgram depths{"depths alone", transforming_shader(), {}, {}};
    for (std::uint32_t i = 0; i < pipeline::semantics; ++i) depths.inputs.push_back({"input" + std::to_string(i), i});
    recording.programs.push_back(depths);
    std::vector<std::uint32_t> bones(200, 0x7FC00001);
    for (std::uint32_t i = 0; i < 100; ++i) bones[i] = 0x01234567 * i;
    recording.values.push_back({{"lights[2].position", words_of_values({0.1F, -0.0F, 1e30F, 1e-30F})},
                                {"count", {3}},
                                {"bones[0]", bones},
                                {"none", {}}});
    recording.values.push_back({{"bones[0]", bones}});
    recording.values.emplace_back();
    traces::TargetSet shadow_targets, mixed;
    shadow_targets.depth = traces::TargetSet::Target{shadow, 0, 0};
    shadow_targets.width = shadow_targets.height = 8;
    shadow_targets.top_row_first = false;
    mixed.colours = {traces::TargetSet::Target{cube, 1, 5}, std::nullopt, traces::TargetSet::Target{cube, 1, 0}};
    mixed.width = mixed.height = 2;
    recording.targets.push_back(shadow_targets);
    recording.targets.push_back(mixed);

    auto& first = recording.frames.front();
    first.number = 7;
    for (auto& command : commands_of_everything(recording, layers)) first.commands.push_back(std::move(command));
    traces::RecordedFrame second{9, 2, {first.commands.front()}};
    for (std::uint32_t i = 0; i < 100; ++i) second.commands.emplace_back(draw_of("again", 0));
    recording.frames.push_back(second);
    recording.not_recorded = {{"glPolygonMode", 3}, {"glBeginTransformFeedback", 1'000'000'000'000}};
    return recording;
}

traces::Trace recorded_trace(traces::Recording recording) {
    traces::Trace trace;
    trace.metadata = {"a test", "rich", "as the project", "a program", ""};
    trace.recording = std::move(recording);
    return trace;
}

} // namespace support
