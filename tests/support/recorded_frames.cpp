#include "tests/support/recorded_frames.hpp"

#include "tests/support/functional_scene.hpp"
#include "tests/support/spirv_assembler.hpp"

#include <cstring>

namespace tests {

namespace {

using Id = SpirvAssembler::Id;
using traces::spirv::Op;
using traces::spirv::Storage;

constexpr std::uint32_t position_number = 0, frag_coord = 15, front_facing = 17;

std::vector<std::uint32_t> vertex_module() {
    SpirvAssembler a(SpirvAssembler::Stage::vertex);
    const Id v4 = a.vector(a.real(), 4);
    const Id place = a.input(v4, 0), colour = a.input(v4, 1);
    a.name(place, "place");
    a.name(colour, "colour");
    const Id varying = a.output(v4, 0);
    a.name(varying, "shade");
    a.store(a.built_in(Storage::output, v4, position_number), a.load(place, v4));
    a.store(varying, a.load(colour, v4));
    return a.module();
}

std::vector<std::uint32_t> fragment_module(RecordedFrames::Shade shade) {
    using Shade = RecordedFrames::Shade;
    SpirvAssembler a;
    const Id v4 = a.vector(a.real(), 4), v2 = a.vector(a.real(), 2);
    const Id varying = a.input(v4, 0), output = a.output(v4, 0);
    a.name(varying, "shade");
    const auto part = [&](Id vector, std::uint32_t i) {
        return a.result(Op::composite_extract, a.real(), {vector, i});
    };
    Id colour = a.load(varying, v4);
    if (shade == Shade::places) {
        const Id place = a.load(a.built_in(Storage::input, v4, frag_coord), v4);
        const Id scale = a.constant(1.0F / 256.0F);
        const Id x = a.result(Op::f_mul, a.real(), {part(place, 0), scale});
        const Id y = a.result(Op::f_mul, a.real(), {part(place, 1), scale});
        const Id z = a.result(Op::f_sub, a.real(), {a.constant(1.0F), part(place, 2)});
        colour = a.result(Op::composite_construct, v4, {x, y, z, part(place, 3)});
    } else if (shade == Shade::textured) {
        const Id type = a.sampled_image(1);
        const Id image = a.load(a.uniform(type, "image"), type);
        const Id place = a.result(Op::composite_construct, v2, {part(colour, 0), part(colour, 1)});
        colour = a.result(Op::image_sample_implicit_lod, v4, {image, place});
    } else if (shade == Shade::facing) {
        const Id front = a.load(a.built_in(Storage::input, a.truth(), front_facing), a.truth());
        const Id white = a.constant(1.0F), black = a.constant(0.0F);
        const Id grey = a.result(Op::select, a.real(), {front, white, black});
        colour = a.result(Op::composite_construct, v4, {grey, grey, grey, white});
    }
    a.store(output, colour);
    return a.module();
}

std::vector<std::byte> bytes_of(const std::vector<std::uint32_t>& rgba_codes) {
    std::vector<std::byte> bytes;
    for (const std::uint32_t code : rgba_codes)
        for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes.push_back(static_cast<std::byte>(code >> shift));
    return bytes;
}

} // namespace

RecordedFrames::RecordedFrames(std::uint32_t width, std::uint32_t height) {
    recording.resources = std::make_shared<pipeline::Resources>();
    recording.surfaces.push_back({.name = "window", .width = width, .height = height});
    recording.surfaces.push_back(
        {.name = "depth", .format = pipeline::SurfaceFormat::d24s8, .width = width, .height = height});
    traces::TargetSet window;
    window.colours = {traces::TargetSet::Target{0, 0, 0}};
    window.depth = traces::TargetSet::Target{1, 0, 0};
    window.width = width;
    window.height = height;
    recording.targets.push_back(window);
    traces::RecordedSampler nearest;
    nearest.min_filter = nearest.mag_filter = pipeline::Filter::nearest;
    nearest.wrap_u = nearest.wrap_v = pipeline::Wrap::clamp;
    recording.samplers.push_back(nearest);
    recording.values.emplace_back();
    recording.bindings.emplace_back();
    pipeline::RasterState state;
    state.culling = pipeline::FaceCulling::none;
    recording.states.push_back(state);
    for (const Shade shade : {Shade::colour, Shade::places, Shade::textured, Shade::facing})
        recording.programs.push_back({"program",
                                      vertex_module(),
                                      fragment_module(shade),
                                      {{"place", static_cast<std::uint32_t>(pipeline::Semantic::position)},
                                       {"colour", static_cast<std::uint32_t>(pipeline::Semantic::generic3)}}});
    recording.frames.emplace_back();
}

std::uint32_t RecordedFrames::add_texture_target(std::uint32_t width, std::uint32_t height) {
    traces::TargetSet targets;
    targets.colours = {traces::TargetSet::Target{static_cast<std::uint32_t>(recording.surfaces.size()), 0, 0}};
    targets.width = width;
    targets.height = height;
    targets.top_row_first = false;
    recording.surfaces.push_back({.name = "texture", .width = width, .height = height});
    recording.targets.push_back(targets);
    return static_cast<std::uint32_t>(recording.targets.size() - 1);
}

std::uint32_t RecordedFrames::add_texture(std::uint32_t width, std::uint32_t height,
                                          const std::vector<std::uint32_t>& rgba_codes) {
    recording.surfaces.push_back({.name = "texture", .width = width, .height = height});
    recording.surfaces.back().levels = {bytes_of(rgba_codes)};
    return static_cast<std::uint32_t>(recording.surfaces.size() - 1);
}

std::uint32_t RecordedFrames::add_state(const pipeline::RasterState& state) {
    recording.states.push_back(state);
    return static_cast<std::uint32_t>(recording.states.size() - 1);
}

std::uint32_t RecordedFrames::bind(std::uint32_t surface) {
    traces::TextureBinding binding;
    binding.variable = "image";
    binding.surface = surface;
    recording.bindings.push_back({binding});
    return static_cast<std::uint32_t>(recording.bindings.size() - 1);
}

traces::RecordedDraw& RecordedFrames::draw(const std::vector<Triangle>& triangles, Shade shade, std::uint32_t state,
                                           std::uint32_t targets) {
    std::vector<Corner> corners;
    for (const Triangle& triangle : triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
    pipeline::Resources& resources = *recording.resources;
    pipeline::Geometry geometry;
    geometry.vertex_count = geometry.index_count = static_cast<std::uint32_t>(corners.size());
    const auto buffer = static_cast<std::uint32_t>(resources.buffers.size());
    resources.buffers.push_back(buffer_of(corners));
    using pipeline::Semantic;
    geometry.attributes = {
        {Semantic::position, pipeline::ComponentType::f32, 4, false, buffer, 0, sizeof(Corner)},
        {Semantic::generic3, pipeline::ComponentType::f32, 4, false, buffer, sizeof(glm::vec4), sizeof(Corner)}};
    resources.geometries.push_back(geometry);
    traces::RecordedDraw draw;
    draw.name = "draw";
    draw.targets = targets;
    draw.geometry = static_cast<std::uint32_t>(resources.geometries.size() - 1);
    draw.program = static_cast<std::uint32_t>(shade);
    draw.state = state;
    auto& commands = recording.frames.back().commands;
    commands.emplace_back(draw);
    return std::get<traces::RecordedDraw>(commands.back());
}

traces::RecordedClear& RecordedFrames::clear(const glm::vec4& colour, std::uint32_t targets) {
    traces::RecordedClear clear;
    clear.name = "clear";
    clear.targets = targets;
    clear.colours = 1;
    clear.colour = colour;
    if (recording.targets[targets].depth) {
        clear.depth = 1.0F;
        clear.stencil = 0;
    }
    auto& commands = recording.frames.back().commands;
    commands.emplace_back(clear);
    return std::get<traces::RecordedClear>(commands.back());
}

void RecordedFrames::next_frame() {
    recording.frames.emplace_back();
    recording.frames.back().number = static_cast<std::uint32_t>(recording.frames.size() - 1);
}

std::vector<RecordedFrames::Triangle> RecordedFrames::everything(const glm::vec4& colour, float depth) {
    return rectangle({-1, -1}, {1, 1}, colour, depth);
}

std::vector<RecordedFrames::Triangle> RecordedFrames::rectangle(const glm::vec2& from, const glm::vec2& to,
                                                                const glm::vec4& colour, float depth) {
    const float z = depth * 2 - 1;
    const auto at = [&](float x, float y) { return Corner{{x, y, z, 1}, colour}; };
    return {{at(from.x, from.y), at(to.x, from.y), at(to.x, to.y)},
            {at(from.x, from.y), at(to.x, to.y), at(from.x, to.y)}};
}

} // namespace tests
