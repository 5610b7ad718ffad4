// From the variables of a SPIR-V program to the surfaces and samplers that a recorded draw binds.
#include "sim/check.hpp"
#include "tests/support/spirv_assembler.hpp"
#include "traces/recording/textures.hpp"

#include <bit>
#include <cstring>
#include <gtest/gtest.h>
#include <optional>

namespace recorded_textures_test {

using namespace traces;
using pipeline::Lanes;
using pipeline::SurfaceFormat;
using tests::SpirvAssembler;
using tests::SpirvRun;
using traces::spirv::Op;
using Id = SpirvAssembler::Id;

constexpr std::uint32_t d2 = 1, cube = 3, buffer = 5; // SPIR-V specification 1.6, section 3.8

template <class Texel>
RecordedSurface recorded(const std::string& name, SurfaceFormat format, std::uint32_t width, std::uint32_t height,
                         const std::vector<Texel>& texels) {
    RecordedSurface surface;
    surface.name = name;
    surface.format = format;
    surface.width = width;
    surface.height = height;
    std::vector<std::byte> bytes(texels.size() * sizeof(Texel));
    std::memcpy(bytes.data(), texels.data(), bytes.size());
    surface.levels[0] = std::move(bytes);
    return surface;
}

TextureBinding binding(const std::string& variable, std::uint32_t surface, std::uint32_t element = 0) {
    TextureBinding bound;
    bound.variable = variable;
    bound.element = element;
    bound.surface = surface;
    return bound;
}

/// Surfaces, bindings and one sampler that takes nearest texels.
struct Bound {
    Bound(const spirv::Program& program, const std::vector<RecordedSurface>& surfaces,
          const std::vector<TextureBinding>& bindings) {
        std::vector<pipeline::SurfaceInfo> list;
        for (const RecordedSurface& surface : surfaces) {
            slots.push_back(static_cast<pipeline::SurfaceId>(slots.size()));
            list.push_back(surface_of(surface));
        }
        store = pipeline::SurfaceStore(list);
        std::vector<RecordedSampler> samplers(1);
        samplers[0].min_filter = samplers[0].mag_filter = pipeline::Filter::nearest;
        std::vector<std::uint32_t> places;
        for (const TextureBinding& bound : bindings) places.push_back(bound.surface);
        table.emplace(program, bindings, samplers, places);
        access.emplace(store, slots, &work);
        textures.emplace(*access, *table);
    }

    std::vector<pipeline::SurfaceId> slots;
    pipeline::SurfaceStore store;
    pipeline::QuadWork work;
    std::optional<TextureTable> table;
    std::optional<pipeline::SurfaceAccess> access;
    std::optional<BoundTextures> textures;
};

void run(SpirvRun& shader, Bound& bound) {
    shader.quad.set_uniforms(shader.uniforms);
    shader.quad.run(*bound.textures);
}

TEST(RecordedTextures, VariablesReadTheirSurfacesThroughTheirSwizzles) {
    SpirvAssembler a;
    const Id v4 = a.vector(a.real(), 4), v2 = a.vector(a.real(), 2), type = a.sampled_image(d2);
    const Id place = a.load(a.input(v2, 0), v2);
    const auto sample = [&](const char* name, std::uint32_t location) {
        const Id texture = a.load(a.uniform(type, name), type);
        a.store(a.output(v4, location), a.result(Op::image_sample_implicit_lod, v4, {texture, place}));
    };
    sample("grey", 0);
    sample("colours", 1);
    sample("nothing", 2);
    SpirvRun shader(a.module());
    shader.quad.set(shader.input(0), 0, {0.25F, 0.75F, 0.25F, 0.75F});
    shader.quad.set(shader.input(0), 1, {0.25F, 0.25F, 0.75F, 0.75F});
    TextureBinding grey = binding("grey", 1);
    grey.swizzle = {Swizzle::red, Swizzle::red, Swizzle::red, Swizzle::one};
    Bound bound(shader.program,
                {recorded<glm::vec4>("c", SurfaceFormat::rgba32f, 2, 2,
                                     {{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}, {12, 13, 14, 15}}),
                 recorded<std::uint8_t>("g", SurfaceFormat::r8, 2, 2, {0, 51, 102, 255})},
                {binding("colours", 0), grey, binding("of another shader", 0)});
    run(shader, bound);
    EXPECT_EQ(shader.real(0, 2), (Lanes{0, 0.2F, 0.4F, 1}));
    EXPECT_EQ(shader.real(0, 3), (Lanes{1, 1, 1, 1}));
    EXPECT_EQ(shader.real(1, 0), (Lanes{0, 4, 8, 12}));
    EXPECT_EQ(shader.real(1, 3), (Lanes{3, 7, 11, 15}));
    EXPECT_EQ(shader.real(2, 0), (Lanes{0, 0, 0, 0}));
    EXPECT_EQ(shader.real(2, 3), (Lanes{1, 1, 1, 1}));
    EXPECT_EQ(bound.table->unbound(), std::vector<std::string>{"nothing"});
    EXPECT_EQ(bound.textures->unbound_reads(), 1U);
    EXPECT_EQ(bound.work.fetches().size(), 2U);
    EXPECT_EQ(bound.work.lines()[0], bound.store.address(1, {0, 0}) / 64);
    EXPECT_EQ(bound.work.instructions(), 0U); // those are the interpreter's to count
}

TEST(RecordedTextures, ElementsOfArraysAreBoundOneByOne) {
    SpirvAssembler a;
    const Id v4 = a.vector(a.real(), 4), v2 = a.vector(a.real(), 2), type = a.sampled_image(d2);
    const Id many = a.uniform(a.array(type, 3), "many"), index = a.load(a.input(a.whole(), 1), a.whole());
    const Id texture =
        a.load(a.result(Op::access_chain, a.pointer(spirv::Storage::uniform_constant, type), {many, index}), type);
    a.store(a.output(v4, 0), a.result(Op::image_sample_implicit_lod, v4, {texture, a.load(a.input(v2, 0), v2)}));
    SpirvRun shader(a.module());
    shader.quad.set_words(shader.input(1), 0, {2, 0, 1, 2});
    Bound bound(
        shader.program,
        {recorded<float>("a", SurfaceFormat::r32f, 1, 1, {10}), recorded<float>("b", SurfaceFormat::r32f, 1, 1, {20})},
        {binding("many", 1, 2), binding("many", 0, 0), binding("many", 0, 3)});
    run(shader, bound);
    EXPECT_EQ(shader.real(0, 0), (Lanes{20, 10, 0, 20}));
    EXPECT_EQ(bound.table->unbound(), std::vector<std::string>{"many[1]"});
}

TEST(RecordedTextures, FetchesOfIntegersAndQueries) {
    SpirvAssembler a;
    const Id i4 = a.vector(a.whole(), 4), i2 = a.vector(a.whole(), 2),
             whole = a.sampled_image(buffer, false, false, a.whole());
    const Id sky = a.sampled_image(cube);
    const auto image = [&](Id of, const char* name) {
        return a.result(Op::image, of - 1, {a.load(a.uniform(of, name), of)}); // its image was declared before it
    };
    const Id bones = image(whole, "bones"), nothing = image(whole, "nothing"), clouds = image(sky, "clouds");
    const Id index = a.load(a.input(a.whole(), 0), a.whole());
    a.store(a.output(i4, 0), a.result(Op::image_fetch, i4, {bones, index}));
    a.store(a.output(i4, 1), a.result(Op::image_fetch, i4, {nothing, index}));
    a.store(a.output(a.whole(), 2), a.result(Op::image_query_size, a.whole(), {bones}));
    a.store(a.output(i2, 3), a.result(Op::image_query_size_lod, i2, {clouds, a.constant(1)}));
    a.store(a.output(a.whole(), 4), a.result(Op::image_query_levels, a.whole(), {clouds}));
    a.store(a.output(a.whole(), 5), a.result(Op::image_query_size, a.whole(), {nothing}));
    SpirvRun shader(a.module());
    shader.quad.set_words(shader.input(0), 0, {0, 2, 3, ~0U});
    RecordedSurface rows = recorded<std::int16_t>("bones", SurfaceFormat::r16i, 3, 1, {-5, 6, -7});
    rows.kind = SurfaceKind::buffer;
    RecordedSurface faces;
    faces.kind = SurfaceKind::cube;
    faces.width = faces.height = 16;
    faces.levels.resize(5);
    Bound bound(shader.program, {rows, faces}, {binding("bones", 0), binding("clouds", 1)});
    run(shader, bound);
    EXPECT_EQ(shader.words(0, 0), (spirv::LaneWords{~0U - 4, ~0U - 6, 0, 0}));
    EXPECT_EQ(shader.words(0, 3), (spirv::LaneWords{1, 1, 0, 0}));
    EXPECT_EQ(shader.words(1, 3), (spirv::LaneWords{1, 1, 1, 1}));
    EXPECT_EQ(shader.words(2)[0], 3U);
    EXPECT_EQ(shader.words(3, 1)[0], 8U);
    EXPECT_EQ(shader.words(4)[0], 5U);
    EXPECT_EQ(shader.words(5)[0], 0U);
    EXPECT_EQ(bound.textures->unbound_reads(), 1U);
}

TEST(RecordedTextures, SurfacesBecomeThoseOfThePipeline) {
    RecordedSurface surface;
    surface.name = "t";
    surface.width = 8;
    surface.height = 4;
    surface.depth = 6;
    surface.levels.resize(3);
    EXPECT_EQ(surface_of(surface).planes, 1U);
    EXPECT_EQ(surface_of(surface).levels, 3U);
    EXPECT_EQ(surface_of(surface).contents, nullptr);
    surface.samples = 4;
    EXPECT_EQ(surface_of(surface).planes, 4U);
    surface.kind = SurfaceKind::volume;
    EXPECT_EQ(surface_of(surface).planes_of(1), 3U);
    surface.kind = SurfaceKind::layers;
    EXPECT_EQ(surface_of(surface).planes_of(1), 6U);
    surface.levels[1] = std::vector<std::byte>(4 * 2 * 6 * 4 - 1);
    EXPECT_THROW(surface_of(surface), sim::InputError);
}

} // namespace recorded_textures_test
