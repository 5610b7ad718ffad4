// Variables, arrays, uniforms and what lies at the border of a shader.
#include "tests/support/spirv_assembler.hpp"

#include "sim/check.hpp"

#include <bit>
#include <gtest/gtest.h>
#include <vector>

namespace spirv_memory_test {

namespace {

using tests::SpirvAssembler;
using tests::SpirvRun;
using traces::spirv::Op;
using traces::spirv::Storage;
using Id = SpirvAssembler::Id;

constexpr std::uint32_t row_major = 4, column_major = 5, matrix_stride = 7, offset = 35;

Id chain(SpirvAssembler& a, Storage storage, Id of, Id variable, SpirvAssembler::Words indices) {
    indices.insert(indices.begin(), variable);
    return a.result(Op::access_chain, a.pointer(storage, of), indices);
}

} // namespace

TEST(SpirvMemory, ArraysInAFunctionWithAnIndexThatVaries) {
    SpirvAssembler a;
    const Id real = a.real(), array = a.array(real, 3);
    const Id start = a.composite(array, {a.constant(1.0F), a.constant(2.0F), a.constant(3.0F)});
    const Id variable = a.local(array, start), index = a.load(a.input(a.whole(), 0), a.whole());
    a.store(a.output(real, 0), a.load(chain(a, Storage::function, real, variable, {index}), real));
    a.store(chain(a, Storage::function, real, variable, {index}), a.constant(9.0F));
    a.store(a.output(array, 1), a.load(variable, array));
    SpirvRun run(a.module());
    run.quad.set_words(run.input(0), 0, {0, 2, 77, 0xFFFFFFF0});
    for (int again = 0; again < 2; ++again) { // each run starts with the initial values
        run.run();
        EXPECT_EQ(run.real(0), (pipeline::Lanes{1, 3, 3, 1}));
        EXPECT_EQ(run.real(1, 0), (pipeline::Lanes{9, 1, 1, 9}));
        EXPECT_EQ(run.real(1, 1), (pipeline::Lanes{2, 2, 2, 2}));
        EXPECT_EQ(run.real(1, 2), (pipeline::Lanes{3, 9, 9, 3}));
    }
}

TEST(SpirvMemory, NestedIndicesThatVary) {
    SpirvAssembler a;
    const Id real = a.real(), inner = a.matrix(2, 3), array = a.array(inner, 2), natural = a.natural();
    const Id variable = a.input(array, 1), index = a.load(a.input(a.vector(natural, 3), 0), a.vector(natural, 3));
    SpirvAssembler::Words indices;
    for (std::uint32_t i = 0; i < 3; ++i) indices.push_back(a.result(Op::composite_extract, natural, {index, i}));
    a.store(a.output(real, 0), a.load(chain(a, Storage::input, real, variable, indices), real));
    a.store(a.output(a.vector(real, 3), 1),
            a.load(chain(a, Storage::input, a.vector(real, 3), variable, {indices[0], indices[1]}), a.vector(real, 3)));
    SpirvRun run(a.module());
    for (std::uint32_t i = 0; i < 12; ++i) {
        const auto value = static_cast<float>(i);
        run.quad.set(run.input(1), i, {value, value + 100, value + 200, value + 300});
    }
    run.quad.set_words(run.input(0), 0, {0, 1, 0, 1});
    run.quad.set_words(run.input(0), 1, {0, 0, 1, 1});
    run.quad.set_words(run.input(0), 2, {2, 1, 0, 5});
    run.run();
    EXPECT_EQ(run.real(0), (pipeline::Lanes{2, 107, 203, 311}));
    EXPECT_EQ(run.real(1, 1), (pipeline::Lanes{1, 107, 204, 310}));
}

TEST(SpirvMemory, BlocksLieAsDeclared) {
    SpirvAssembler a;
    const Id real = a.real(), v2 = a.vector(real, 2), m = a.matrix(2, 2), array = a.array_with_stride(v2, 3, 16);
    const Id structure = a.structure({real, m, m, array});
    const std::vector<std::uint32_t> offsets{4, 16, 48, 80};
    for (std::uint32_t i = 0; i < 4; ++i) a.decorate_member(structure, i, offset, {offsets[i]});
    a.decorate_member(structure, 1, column_major);
    a.decorate_member(structure, 1, matrix_stride, {16});
    a.decorate_member(structure, 2, row_major);
    a.decorate_member(structure, 2, matrix_stride, {16});
    a.name_member(structure, 1, "columns");
    a.name_member(structure, 3, "list");
    const Id block = a.block(structure, "Scene");
    const auto at = [&](Id of, SpirvAssembler::Words indices) {
        return a.load(chain(a, Storage::uniform, of, block, std::move(indices)), of);
    };
    a.store(a.output(real, 0), at(real, {a.constant(0)}));
    a.store(a.output(m, 1), at(m, {a.constant(1)}));
    a.store(a.output(m, 2), at(m, {a.constant(2)}));
    a.store(a.output(v2, 3), at(v2, {a.constant(3), a.load(a.input(a.whole(), 0), a.whole())}));
    a.store(a.output(v2, 4), at(v2, {a.constant(2), a.constant(1)}));
    const Id component = a.load(a.input(a.whole(), 1), a.whole());
    a.store(a.output(real, 5), at(real, {a.constant(2), a.constant(1), component}));
    SpirvRun run(a.module());
    ASSERT_EQ(run.program.uniforms.size(), 1U);
    EXPECT_EQ(run.program.uniforms[0].name, "Scene");
    EXPECT_EQ(run.program.uniforms[0].words, (80U + 2 * 16 + 8) / 4);
    for (std::uint32_t i = 0; i < run.uniforms.size(); ++i)
        run.uniforms[i] = std::bit_cast<std::uint32_t>(static_cast<float>(i));
    run.quad.set_words(run.input(0), 0, {0, 1, 2, 3});
    run.quad.set_words(run.input(1), 0, {0, 1, 0, 1});
    run.run();
    EXPECT_EQ(run.real(0)[0], 1);
    const std::vector<float> columns{4, 5, 8, 9}, rows{12, 16, 13, 17};
    for (std::uint32_t i = 0; i < 4; ++i) {
        EXPECT_EQ(run.real(1, i)[3], columns[i]);
        EXPECT_EQ(run.real(2, i)[3], rows[i]);
    }
    EXPECT_EQ(run.real(3, 1), (pipeline::Lanes{21, 25, 29, 29}));
    EXPECT_EQ(run.real(4, 0)[1], 13);
    EXPECT_EQ(run.real(4, 1)[1], 17);
    EXPECT_EQ(run.real(5), (pipeline::Lanes{13, 17, 13, 17}));
    const auto place = run.program.uniform(run.module, "Scene.list[1]");
    ASSERT_TRUE(place);
    EXPECT_EQ(place->first, 24U);
    EXPECT_EQ(place->components, 2U);
    EXPECT_EQ(run.program.uniform(run.module, "Scene.list")->element_stride, 4U);
    EXPECT_EQ(run.program.uniform(run.module, "Scene.columns")->column_stride, 4U);
    for (const char* wrong :
         {"Scene", "Scene.list[3]", "Scene.nothing", "Other", "", "Scene..list", "Scene.list[", "Scene.list[x]"})
        EXPECT_FALSE(run.program.uniform(run.module, wrong)) << wrong;
}

TEST(SpirvMemory, PlainUniformsLieWithoutGaps) {
    SpirvAssembler a;
    const Id real = a.real(), truth = a.truth(), array = a.array(real, 2);
    const Id light = a.structure({a.vector(real, 3), array});
    a.name_member(light, 0, "position");
    a.name_member(light, 1, "range");
    const Id lights = a.uniform(a.array(light, 2), "lights"), flags = a.uniform(a.array(truth, 2), "flags");
    const Id index = a.load(a.input(a.whole(), 0), a.whole());
    a.store(a.output(real, 0),
            a.load(chain(a, Storage::uniform_constant, real, lights, {index, a.constant(1), index}), real));
    const auto flag = [&](Id which) {
        const Id loaded = a.load(chain(a, Storage::uniform_constant, truth, flags, {which}), truth);
        return a.result(Op::select, real, {loaded, a.constant(1.0F), a.constant(0.0F)});
    };
    a.store(a.output(real, 1), flag(index));
    a.store(a.output(real, 2), flag(a.constant(1)));
    SpirvRun run(a.module());
    const auto range = run.program.uniform(run.module, "lights[1].range[1]"),
               first = run.program.uniform(run.module, "lights[0].range");
    const auto place = run.program.uniform(run.module, "flags");
    ASSERT_TRUE(range && first && place);
    EXPECT_EQ(range->first, 9U);
    EXPECT_EQ(first->elements, 2U);
    run.uniforms[range->first] = std::bit_cast<std::uint32_t>(7.0F);
    run.uniforms[first->first] = std::bit_cast<std::uint32_t>(5.0F);
    run.uniforms[place->first + 1] = 3; // any word that is not 0
    run.quad.set_words(run.input(0), 0, {0, 1, 1, 0});
    run.run();
    EXPECT_EQ(run.real(0), (pipeline::Lanes{5, 7, 7, 5}));
    EXPECT_EQ(run.real(1), (pipeline::Lanes{0, 1, 1, 0}));
    EXPECT_EQ(run.real(2), (pipeline::Lanes{1, 1, 1, 1}));
}

TEST(SpirvMemory, TheBorderIsDescribed) {
    SpirvAssembler a;
    constexpr std::uint32_t flat = 14, frag_depth = 22, position = 0, block = 2, built_in = 11;
    const Id v3 = a.vector(a.real(), 3);
    const Id normal = a.input(v3, 2);
    a.name(normal, "normal");
    a.decorate(normal, flat);
    const Id depth = a.built_in(Storage::output, a.real(), frag_depth);
    const Id vertex = a.structure({a.vector(a.real(), 4), a.real()});
    a.decorate(vertex, block);
    a.decorate_member(vertex, 0, built_in, {position});
    a.name_member(vertex, 1, "gl_PointSize");
    a.input(vertex, 5);
    a.store(depth, a.result(Op::composite_extract, a.real(), {a.load(normal, v3), 1}));
    SpirvRun run(a.module());
    const auto* found = run.program.input("normal");
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->components, 3U);
    EXPECT_TRUE(found->decorations.flat);
    EXPECT_EQ(found->decorations.location, 2U);
    EXPECT_EQ(run.program.built_in(position)->components, 4U);
    EXPECT_NE(run.program.input("gl_PointSize"), nullptr);
    EXPECT_EQ(run.program.input("nothing"), nullptr);
    ASSERT_NE(run.program.built_in(frag_depth), nullptr);
    run.quad.set(*found, 1, {1, 2, 3, 4});
    run.run();
    EXPECT_EQ(run.quad.get(*run.program.built_in(frag_depth), 0), (pipeline::Lanes{1, 2, 3, 4}));
}

TEST(SpirvMemory, OutputsThatNobodyWritesAreNought) {
    SpirvAssembler a;
    const Id real = a.real(), written = a.output(real, 0);
    a.output(real, 1);
    const Id counter = a.global(Storage::invocation, real, a.constant(4.0F));
    a.store(counter, a.result(Op::f_add, real, {a.load(counter, real), a.constant(1.0F)}));
    a.store(written, a.load(counter, real));
    SpirvRun run(a.module());
    for (int again = 0; again < 3; ++again) {
        run.run();
        EXPECT_EQ(run.real(0)[0], 5);
        EXPECT_EQ(run.real(1)[0], 0);
    }
}

TEST(SpirvMemory, WhatMayNotBeWrittenIsRefused) {
    SpirvAssembler a;
    a.store(a.input(a.real(), 0), a.constant(1.0F));
    EXPECT_THROW(SpirvRun(a.module()), sim::InputError);
    SpirvAssembler b;
    b.store(b.uniform(b.real(), "u"), b.constant(1.0F));
    EXPECT_THROW(SpirvRun(b.module()), sim::InputError);
}

} // namespace spirv_memory_test
