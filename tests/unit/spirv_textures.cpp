// What reaches the textures of a shader.
#include "tests/support/spirv_assembler.hpp"

#include "sim/check.hpp"

#include <gtest/gtest.h>

namespace spirv_textures_test {

namespace {

using pipeline::Lanes;
using tests::SpirvAssembler;
using tests::SpirvRun;
using traces::spirv::ImageDimension;
using traces::spirv::LevelOfDetail;
using traces::spirv::Op;
using traces::spirv::Storage;
using Id = SpirvAssembler::Id;

constexpr std::uint32_t d2 = 1, d3 = 2, cube = 3, buffer = 5;
// SPIR-V specification 1.6, section 3.14.
constexpr std::uint32_t bias = 1, lod = 2, gradients = 4, const_offset = 8, offset = 16, sample = 64;

/// A coordinate whose component i is lane + 10 i in lane.
Id coordinates(SpirvAssembler& a, std::uint32_t n) {
    return a.load(a.input(a.vector(a.real(), n), 0), a.vector(a.real(), n));
}
void fill(SpirvRun& run) {
    const auto& input = run.input(0);
    for (std::uint32_t i = 0; i < input.components; ++i) {
        const auto first = static_cast<float>(10 * i + 2);
        run.quad.set(input, i, {first, first + 1, first + 2, first + 3});
    }
}

} // namespace

TEST(SpirvTextures, CoordinatesBiasAndResult) {
    SpirvAssembler a;
    const Id v4 = a.vector(a.real(), 4), type = a.sampled_image(d2);
    const Id texture = a.load(a.uniform(type, "colours"), type);
    a.store(a.output(v4, 0),
            a.result(Op::image_sample_implicit_lod, v4, {texture, coordinates(a, 2), bias, a.constant(1.5F)}));
    SpirvRun run(a.module());
    fill(run);
    run.run();
    ASSERT_EQ(run.textures.sampled.size(), 1U);
    const auto& call = run.textures.sampled[0];
    EXPECT_EQ(run.program.textures.at(call.texture).name, "colours");
    EXPECT_EQ(call.sampler, call.texture);
    EXPECT_EQ(call.lanes, 15U);
    EXPECT_EQ(call.level, LevelOfDetail::implicit);
    EXPECT_EQ(call.lod[0], 1.5F);
    EXPECT_EQ(call.place[0], (Lanes{2, 3, 4, 5}));
    EXPECT_EQ(call.place[1], (Lanes{12, 13, 14, 15}));
    EXPECT_FALSE(call.compares);
    EXPECT_EQ(run.real(0, 1), (Lanes{12, 13, 14, 15}));
    EXPECT_EQ(run.real(0, 3), (Lanes{1, 2, 3, 4}));
}

TEST(SpirvTextures, ProjectionDividesReferenceAndCoordinates) {
    SpirvAssembler a;
    const Id type = a.sampled_image(d2, true), texture = a.load(a.uniform(type, "shadow"), type), x = coordinates(a, 4);
    const Id depth = a.result(Op::composite_extract, a.real(), {x, 3});
    a.store(a.output(a.real(), 0), a.result(Op::image_sample_proj_dref_implicit_lod, a.real(), {texture, x, depth}));
    SpirvRun run(a.module());
    fill(run);
    run.run();
    const auto& call = run.textures.sampled.at(0);
    EXPECT_TRUE(call.compares);
    EXPECT_TRUE(call.image->depth);
    EXPECT_EQ(call.place[0][1], 3.0F / 23.0F);
    EXPECT_EQ(call.place[1][1], 13.0F / 23.0F);
    EXPECT_EQ(call.reference[1], 33.0F / 23.0F);
    EXPECT_EQ(run.real(0)[1], 3.0F / 23.0F);
}

TEST(SpirvTextures, LevelsGradientsAndOffsets) {
    SpirvAssembler a;
    const Id v2 = a.vector(a.real(), 2), v4 = a.vector(a.real(), 4), i2 = a.vector(a.whole(), 2),
             type = a.sampled_image(d2);
    const Id texture = a.load(a.uniform(type, "t"), type), x = coordinates(a, 2);
    const Id moved = a.composite(i2, {a.constant(-1), a.constant(2)});
    const Id dx = a.composite(v2, {a.constant(0.25F), a.constant(0.5F)}),
             dy = a.composite(v2, {a.constant(1.0F), a.constant(2.0F)});
    a.result(Op::image_sample_explicit_lod, v4, {texture, x, lod | const_offset, a.constant(3.0F), moved});
    a.result(Op::image_sample_explicit_lod, v4, {texture, x, gradients | offset, dx, dy, moved});
    a.result(Op::image_gather, v4, {texture, x, a.constant(2)});
    SpirvRun run(a.module());
    fill(run);
    run.run();
    ASSERT_EQ(run.textures.sampled.size(), 3U);
    EXPECT_EQ(run.textures.sampled[0].level, LevelOfDetail::given);
    EXPECT_EQ(run.textures.sampled[0].lod[2], 3);
    EXPECT_EQ(run.textures.sampled[0].offset[0][1], -1);
    EXPECT_EQ(run.textures.sampled[1].level, LevelOfDetail::gradients);
    EXPECT_EQ(run.textures.sampled[1].dx[1][3], 0.5F);
    EXPECT_EQ(run.textures.sampled[1].dy[0][3], 1.0F);
    EXPECT_EQ(run.textures.sampled[1].offset[1][0], 2);
    EXPECT_TRUE(run.textures.sampled[2].gathers);
    EXPECT_EQ(run.textures.sampled[2].component, 2U);
}

TEST(SpirvTextures, FetchesAndQueries) {
    SpirvAssembler a;
    const Id i2 = a.vector(a.whole(), 2), v4 = a.vector(a.real(), 4), type = a.sampled_image(d2),
             buffers = a.sampled_image(buffer);
    const Id cubes = a.sampled_image(cube);
    const auto image = [&](Id of, const char* name) {
        const Id loaded = a.load(a.uniform(of, name), of);
        // The image's type is the one that was declared before the sampled image's.
        return a.result(Op::image, of - 1, {loaded});
    };
    const Id texture = image(type, "t"), texels = image(buffers, "b"), sky = image(cubes, "c");
    const Id place = a.result(Op::convert_float_to_signed, i2, {coordinates(a, 2)});
    a.store(a.output(v4, 0), a.result(Op::image_fetch, v4,
                                      {texture, place, lod | const_offset, a.constant(1),
                                       a.composite(i2, {a.constant(5), a.constant(-5)})}));
    a.store(a.output(v4, 1),
            a.result(Op::image_fetch, v4, {texels, a.result(Op::composite_extract, a.whole(), {place, 1})}));
    a.store(a.output(i2, 2), a.result(Op::image_query_size_lod, i2, {texture, a.constant(1)}));
    a.store(a.output(i2, 3), a.result(Op::image_query_size_lod, i2, {sky, a.constant(0)}));
    a.store(a.output(a.whole(), 4), a.result(Op::image_query_levels, a.whole(), {texture}));
    a.store(a.output(a.whole(), 5), a.result(Op::image_query_size, a.whole(), {texels}));
    SpirvRun run(a.module());
    fill(run);
    run.run();
    ASSERT_EQ(run.textures.fetched.size(), 2U);
    EXPECT_EQ(run.textures.fetched[0].level[3], 1);
    EXPECT_EQ(run.real(0, 0), (Lanes{7, 8, 9, 10}));
    EXPECT_EQ(run.real(0, 1), (Lanes{7, 8, 9, 10}));
    EXPECT_EQ(run.real(1, 0), (Lanes{12, 13, 14, 15}));
    EXPECT_EQ(run.textures.fetched[1].image->dimension, ImageDimension::buffer);
    EXPECT_EQ(run.words(2, 0)[0], 32U);
    EXPECT_EQ(run.words(2, 1)[0], 16U);
    EXPECT_EQ(run.words(3, 1)[2], 32U);
    EXPECT_EQ(run.words(4)[1], 7U);
    EXPECT_EQ(run.words(5)[1], 64U);
}

TEST(SpirvTextures, ArraysOfTexturesAskForEachElementOnce) {
    SpirvAssembler a;
    const Id v4 = a.vector(a.real(), 4), type = a.sampled_image(d3), textures = a.uniform(a.array(type, 3), "many");
    const Id index = a.load(a.input(a.whole(), 1), a.whole());
    const Id texture =
        a.load(a.result(Op::access_chain, a.pointer(Storage::uniform_constant, type), {textures, index}), type);
    a.store(a.output(v4, 0), a.result(Op::image_sample_implicit_lod, v4, {texture, coordinates(a, 3)}));
    SpirvRun run(a.module());
    fill(run);
    run.quad.set_words(run.input(1), 0, {2, 0, 9, 0});
    run.run();
    EXPECT_EQ(run.program.textures[0].elements, 3U);
    ASSERT_EQ(run.textures.sampled.size(), 2U);
    EXPECT_EQ(run.textures.sampled[0].element, 2U);
    EXPECT_EQ(run.textures.sampled[0].lanes, 0b0101U);
    EXPECT_EQ(run.textures.sampled[1].element, 0U);
    EXPECT_EQ(run.textures.sampled[1].lanes, 0b1010U);
    EXPECT_EQ(run.real(0, 2), (Lanes{22, 23, 24, 25}));
}

TEST(SpirvTextures, OnlyLanesThatRunAskButAllHaveCoordinates) {
    SpirvAssembler a;
    const Id v4 = a.vector(a.real(), 4), type = a.sampled_image(d2), texture = a.load(a.uniform(type, "t"), type);
    const Id x = coordinates(a, 2), output = a.output(v4, 0), yes = a.id(), merge = a.id();
    const Id first = a.result(Op::composite_extract, a.real(), {x, 0});
    a.write(Op::selection_merge, {merge, 0});
    a.write(Op::branch_conditional, {a.result(Op::f_ord_less_than, a.truth(), {first, a.constant(3.5F)}), yes, merge});
    a.label(yes);
    a.store(output, a.result(Op::image_sample_implicit_lod, v4, {texture, x}));
    a.write(Op::branch, {merge});
    a.label(merge);
    SpirvRun run(a.module());
    fill(run);
    run.run();
    const auto& call = run.textures.sampled.at(0);
    EXPECT_EQ(call.lanes, 0b0011U);
    EXPECT_EQ(call.place[0], (Lanes{2, 3, 4, 5}));
    EXPECT_EQ(run.real(0, 1), (Lanes{12, 13, 0, 0}));
}

TEST(SpirvTextures, WhatDoesNotFitIsRefused) {
    SpirvAssembler a;
    const Id v4 = a.vector(a.real(), 4), type = a.sampled_image(cube), texture = a.load(a.uniform(type, "t"), type);
    a.result(Op::image_sample_implicit_lod, v4, {texture, coordinates(a, 2)});
    EXPECT_THROW(SpirvRun(a.module()), sim::InputError);
    SpirvAssembler b;
    const Id plain = b.sampled_image(d2), loaded = b.load(b.uniform(plain, "t"), plain);
    b.result(Op::image_sample_implicit_lod, b.vector(b.real(), 4),
             {loaded, coordinates(b, 2), sample, b.constant(1.0F)});
    EXPECT_THROW(SpirvRun(b.module()), sim::InputError);
}

} // namespace spirv_textures_test
