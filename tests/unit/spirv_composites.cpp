// Vectors, matrices, structures: their parts, products and functions.
#include "tests/support/spirv_assembler.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace spirv_composites_test {

namespace {

using tests::SpirvAssembler;
using tests::SpirvRun;
using traces::spirv::Op;
using traces::spirv::Std450;
using Id = SpirvAssembler::Id;

/// A constant vector or matrix (by columns).
Id vector(SpirvAssembler& a, const std::vector<float>& values) {
    SpirvAssembler::Words parts;
    for (const float value : values) parts.push_back(a.constant(value));
    return a.composite(a.vector(a.real(), static_cast<std::uint32_t>(values.size())), parts);
}
Id matrix(SpirvAssembler& a, const std::vector<std::vector<float>>& columns) {
    SpirvAssembler::Words parts;
    for (const auto& column : columns) parts.push_back(vector(a, column));
    return a.composite(
        a.matrix(static_cast<std::uint32_t>(columns.size()), static_cast<std::uint32_t>(columns[0].size())), parts);
}

/// The first lane of all scalars that `make` computes with this type.
template <class Make>
std::vector<float> values(SpirvAssembler& a, Id type, Make make) {
    a.store(a.output(type, 0), make());
    SpirvRun run(a.module());
    run.run();
    const auto& output = run.output(0);
    std::vector<float> result(output.components * output.columns * output.elements);
    for (std::uint32_t i = 0; i < result.size(); ++i) {
        result[i] = run.real(0, i)[0];
        for (const float lane : run.real(0, i))
            EXPECT_EQ(std::bit_cast<std::uint32_t>(lane), std::bit_cast<std::uint32_t>(result[i]));
    }
    return result;
}

using Values = std::vector<float>;

} // namespace

TEST(SpirvComposites, ShuffleExtractInsert) {
    SpirvAssembler a;
    const Id v4 = a.vector(a.real(), 4);
    const Id x = vector(a, {1, 2, 3, 4}), y = vector(a, {5, 6});
    EXPECT_EQ(values(a, v4,
                     [&] {
                         return a.result(Op::vector_shuffle, v4, {x, y, 5, 0, 0xFFFFFFFF, 4});
                     }),
              (Values{6, 1, 1, 5}));
    SpirvAssembler b;
    const Id b3 = b.vector(b.real(), 3);
    EXPECT_EQ(
        values(b, b3,
               [&] {
                   return b.result(Op::vector_shuffle, b3, {vector(b, {1, 2, 3, 4}), vector(b, {5, 6, 7, 8}), 2, 3, 4});
               }),
        (Values{3, 4, 5}));
    SpirvAssembler c;
    const Id c4 = c.vector(c.real(), 4);
    EXPECT_EQ(values(c, c4,
                     [&] {
                         return c.result(Op::composite_insert, c4, {c.constant(9.0F), vector(c, {1, 2, 3, 4}), 2});
                     }),
              (Values{1, 2, 9, 4}));
    SpirvAssembler d;
    EXPECT_EQ(values(d, d.real(),
                     [&] {
                         return d.result(Op::composite_extract, d.real(), {matrix(d, {{1, 2}, {3, 4}, {5, 6}}), 2, 0});
                     }),
              (Values{5}));
}

TEST(SpirvComposites, ConstructJoinsVectorsAndFillsStructures) {
    SpirvAssembler a;
    const Id v4 = a.vector(a.real(), 4), v2 = a.vector(a.real(), 2);
    const Id structure = a.structure({a.real(), a.array(v2, 2), a.matrix(2, 2)});
    EXPECT_EQ(values(a, v4,
                     [&] {
                         const Id pairs =
                             a.result(Op::composite_construct, a.array(v2, 2), {vector(a, {1, 2}), vector(a, {3, 4})});
                         const Id square =
                             a.result(Op::composite_construct, a.matrix(2, 2), {vector(a, {5, 6}), vector(a, {7, 8})});
                         const Id all = a.result(Op::composite_construct, structure, {a.constant(9.0F), pairs, square});
                         const Id moved = a.result(Op::composite_insert, structure, {vector(a, {10, 11}), all, 1, 1});
                         return a.result(Op::composite_construct, v4,
                                         {a.result(Op::composite_extract, a.real(), {moved, 0}),
                                          a.result(Op::composite_extract, v2, {moved, 1, 1}),
                                          a.result(Op::composite_extract, a.real(), {moved, 2, 1, 0})});
                     }),
              (Values{9, 10, 11, 7}));
}

TEST(SpirvComposites, ComponentsByAnIndexThatVariesAreClamped) {
    SpirvAssembler a;
    const Id v3 = a.vector(a.real(), 3);
    const Id index = a.load(a.input(a.whole(), 0), a.whole());
    a.store(a.output(a.real(), 0), a.result(Op::vector_extract_dynamic, a.real(), {vector(a, {5, 6, 7}), index}));
    a.store(a.output(v3, 1), a.result(Op::vector_insert_dynamic, v3, {vector(a, {5, 6, 7}), a.constant(1.0F), index}));
    SpirvRun run(a.module());
    run.quad.set_words(run.input(0), 0, {0, 2, 3, 0xFFFFFFFF});
    run.run();
    EXPECT_EQ(run.real(0), (pipeline::Lanes{5, 7, 7, 5}));
    EXPECT_EQ(run.real(1, 0), (pipeline::Lanes{1, 5, 5, 1}));
    EXPECT_EQ(run.real(1, 2), (pipeline::Lanes{7, 1, 1, 7}));
}

TEST(SpirvComposites, ProductsOfMatrices) {
    const std::vector<std::vector<float>> m{{1, 2, 3}, {4, 5, 6}}; // 2 columns, 3 rows
    SpirvAssembler a;
    EXPECT_EQ(
        values(
            a, a.vector(a.real(), 3),
            [&] {
                return a.result(Op::matrix_times_vector, a.vector(a.real(), 3), {matrix(a, m), vector(a, {10, 100})});
            }),
        (Values{410, 520, 630}));
    SpirvAssembler b;
    EXPECT_EQ(values(b, b.vector(b.real(), 2),
                     [&] {
                         return b.result(Op::vector_times_matrix, b.vector(b.real(), 2),
                                         {vector(b, {1, 10, 100}), matrix(b, m)});
                     }),
              (Values{321, 654}));
    SpirvAssembler c;
    EXPECT_EQ(values(c, c.matrix(3, 3),
                     [&] {
                         return c.result(Op::matrix_times_matrix, c.matrix(3, 3),
                                         {matrix(c, m), matrix(c, {{1, 0}, {0, 1}, {1, 10}})});
                     }),
              (Values{1, 2, 3, 4, 5, 6, 41, 52, 63}));
    SpirvAssembler d;
    EXPECT_EQ(values(d, d.matrix(3, 2), [&] { return d.result(Op::transpose, d.matrix(3, 2), {matrix(d, m)}); }),
              (Values{1, 4, 2, 5, 3, 6}));
    SpirvAssembler e;
    EXPECT_EQ(values(e, e.matrix(2, 3),
                     [&] {
                         return e.result(Op::outer_product, e.matrix(2, 3), {vector(e, {1, 2, 3}), vector(e, {1, 10})});
                     }),
              (Values{1, 2, 3, 10, 20, 30}));
    SpirvAssembler f;
    EXPECT_EQ(values(f, f.matrix(2, 3),
                     [&] {
                         return f.result(Op::matrix_times_scalar, f.matrix(2, 3), {matrix(f, m), f.constant(2.0F)});
                     }),
              (Values{2, 4, 6, 8, 10, 12}));
    SpirvAssembler g;
    EXPECT_EQ(values(g, g.real(),
                     [&] {
                         return g.result(Op::dot, g.real(), {vector(g, {1, 2, 3, 4}), vector(g, {5, 6, 7, 8})});
                     }),
              (Values{70}));
    SpirvAssembler h;
    EXPECT_EQ(
        values(
            h, h.vector(h.real(), 2),
            [&] {
                return h.result(Op::vector_times_scalar, h.vector(h.real(), 2), {vector(h, {1, 2}), h.constant(3.0F)});
            }),
        (Values{3, 6}));
}

TEST(SpirvComposites, InversesAndDeterminants) {
    const std::vector<std::vector<std::vector<float>>> matrices{
        {{2, 1}, {4, 4}}, {{2, 0, 1}, {0, 4, 0}, {1, 0, 1}}, {{2, 0, 0, 1}, {0, 4, 0, 0}, {0, 1, 8, 0}, {1, 0, 0, 1}}};
    const std::array<float, 3> determinants{4, 4, 32};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto n = static_cast<std::uint32_t>(matrices[i].size());
        SpirvAssembler a;
        EXPECT_EQ(
            values(a, a.real(), [&] { return a.extended(Std450::determinant, a.real(), {matrix(a, matrices[i])}); }),
            (Values{determinants[i]}));
        SpirvAssembler b;
        const Values product = values(b, b.matrix(n, n), [&] {
            const Id m = matrix(b, matrices[i]);
            return b.result(Op::matrix_times_matrix, b.matrix(n, n),
                            {b.extended(Std450::matrix_inverse, b.matrix(n, n), {m}), m});
        });
        for (std::uint32_t k = 0; k < n * n; ++k)
            EXPECT_EQ(product[k], k % (n + 1) == 0 ? 1.0F : 0.0F) << n << ", " << k;
    }
}

TEST(SpirvComposites, Geometry) {
    const auto three = [](Std450 function, const std::vector<std::vector<float>>& operands) {
        SpirvAssembler a;
        const Id type = a.vector(a.real(), 3);
        return values(a, type, [&] {
            SpirvAssembler::Words ids;
            for (const auto& operand : operands)
                ids.push_back(operand.size() == 1 ? a.constant(operand[0]) : vector(a, operand));
            return a.extended(function, type, ids);
        });
    };
    const auto one = [](Std450 function, const std::vector<std::vector<float>>& operands) {
        SpirvAssembler a;
        return values(a, a.real(), [&] {
            SpirvAssembler::Words ids;
            for (const auto& operand : operands)
                ids.push_back(operand.size() == 1 ? a.constant(operand[0]) : vector(a, operand));
            return a.extended(function, a.real(), ids);
        })[0];
    };
    EXPECT_EQ(one(Std450::length, {{3, 4}}), 5);
    EXPECT_EQ(one(Std450::length, {{-3}}), 3);
    EXPECT_EQ(one(Std450::distance, {{1, 1, 1}, {1, 4, 5}}), 5);
    EXPECT_EQ(three(Std450::cross, {{1, 2, 3}, {4, 5, 6}}), (Values{-3, 6, -3}));
    EXPECT_EQ(three(Std450::normalize, {{0, 0, -4}}), (Values{0, 0, -1}));
    EXPECT_EQ(three(Std450::face_forward, {{1, 2, 3}, {0, 0, 1}, {0, 0, 2}}), (Values{-1, -2, -3}));
    EXPECT_EQ(three(Std450::face_forward, {{1, 2, 3}, {0, 0, 1}, {0, 0, -2}}), (Values{1, 2, 3}));
    EXPECT_EQ(three(Std450::reflect, {{1, -1, 0}, {0, 1, 0}}), (Values{1, 1, 0}));
    EXPECT_EQ(three(Std450::refract, {{0, -1, 0}, {0, 1, 0}, {0.5F}}), (Values{0, -1, 0}));
    EXPECT_EQ(three(Std450::refract, {{0.8F, -0.6F, 0}, {0, 1, 0}, {2.0F}}), (Values{0, 0, 0})); // total reflection
}

TEST(SpirvComposites, AnyAndAll) {
    SpirvAssembler a;
    const Id b3 = a.vector(a.truth(), 3), v3 = a.vector(a.real(), 3);
    const Id x = a.load(a.input(v3, 0), v3), positive = a.result(Op::f_ord_greater_than, b3, {x, vector(a, {0, 0, 0})});
    const Id one = a.constant(1), zero = a.constant(0);
    a.store(a.output(a.whole(), 0),
            a.result(Op::select, a.whole(), {a.result(Op::any, a.truth(), {positive}), one, zero}));
    a.store(a.output(a.whole(), 1),
            a.result(Op::select, a.whole(), {a.result(Op::all, a.truth(), {positive}), one, zero}));
    a.store(a.output(v3, 2),
            a.result(Op::select, v3, {a.result(Op::all, a.truth(), {positive}), x, vector(a, {7, 8, 9})}));
    SpirvRun run(a.module());
    run.quad.set(run.input(0), 0, {1, 1, 0, 0});
    run.quad.set(run.input(0), 1, {1, 0, 1, 0});
    run.quad.set(run.input(0), 2, {1, 0, 0, 0});
    run.run();
    EXPECT_EQ(run.words(0), (traces::spirv::LaneWords{1, 1, 1, 0}));
    EXPECT_EQ(run.words(1), (traces::spirv::LaneWords{1, 0, 0, 0}));
    EXPECT_EQ(run.real(2, 1), (pipeline::Lanes{1, 8, 8, 8}));
}

TEST(SpirvComposites, PairsOfResults) {
    SpirvAssembler a;
    const Id natural = a.natural(), pair = a.structure({natural, natural});
    const Id x = a.load(a.input(natural, 0), natural), y = a.load(a.input(natural, 1), natural);
    std::uint32_t location = 0;
    for (const Op op : {Op::i_add_carry, Op::i_sub_borrow, Op::u_mul_extended, Op::s_mul_extended}) {
        const Id both = a.result(op, pair, {x, y});
        for (std::uint32_t part = 0; part < 2; ++part)
            a.store(a.output(natural, location++), a.result(Op::composite_extract, natural, {both, part}));
    }
    SpirvRun run(a.module());
    run.quad.set_words(run.input(0), 0, {1, 0xFFFFFFFF, 5, 0x80000000});
    run.quad.set_words(run.input(1), 0, {2, 2, 7, 2});
    run.run();
    using Lanes = traces::spirv::LaneWords;
    EXPECT_EQ(run.words(0), (Lanes{3, 1, 12, 0x80000002}));
    EXPECT_EQ(run.words(1), (Lanes{0, 1, 0, 0}));
    EXPECT_EQ(run.words(2), (Lanes{0xFFFFFFFF, 0xFFFFFFFD, 0xFFFFFFFE, 0x7FFFFFFE}));
    EXPECT_EQ(run.words(3), (Lanes{1, 0, 1, 0}));
    EXPECT_EQ(run.words(4), (Lanes{2, 0xFFFFFFFE, 35, 0}));
    EXPECT_EQ(run.words(5), (Lanes{0, 1, 0, 1}));
    EXPECT_EQ(run.words(6), (Lanes{2, 0xFFFFFFFE, 35, 0}));
    EXPECT_EQ(run.words(7), (Lanes{0, 0xFFFFFFFF, 0, 0xFFFFFFFF}));
}

TEST(SpirvComposites, NumbersTakenApart) {
    SpirvAssembler a;
    const Id real = a.real(), whole = a.whole(), x = a.load(a.input(real, 0), real);
    const Id part = a.local(real), exponent = a.local(whole);
    a.store(a.output(real, 0), a.extended(Std450::modf, real, {x, part}));
    a.store(a.output(real, 1), a.load(part, real));
    a.store(a.output(real, 2), a.extended(Std450::frexp, real, {x, exponent}));
    a.store(a.output(whole, 3), a.load(exponent, whole));
    const Id both = a.extended(Std450::frexp_struct, a.structure({real, whole}), {x});
    a.store(a.output(whole, 4), a.result(Op::composite_extract, whole, {both, 1}));
    SpirvRun run(a.module());
    run.quad.set(run.input(0), 0, {2.75F, -2.75F, 0.0F, 8.0F});
    run.run();
    EXPECT_EQ(run.real(0), (pipeline::Lanes{0.75F, -0.75F, 0, 0}));
    EXPECT_EQ(run.real(1), (pipeline::Lanes{2, -2, 0, 8}));
    EXPECT_EQ(run.real(2), (pipeline::Lanes{0.6875F, -0.6875F, 0, 0.5F}));
    EXPECT_EQ(run.words(3), (traces::spirv::LaneWords{2, 2, 0, 4}));
    EXPECT_EQ(run.words(4), run.words(3));
}

TEST(SpirvComposites, PackingsAndTheirInverses) {
    struct Case {
        Std450 pack, unpack;
        std::vector<float> in;
        std::uint32_t word;
        std::vector<float> out;
    };
    const std::vector<Case> cases{
        {Std450::pack_unorm_4x8, Std450::unpack_unorm_4x8, {0, 1, 0.5F, 7}, 0xFF80FF00, {0, 1, 128.0F / 255.0F, 1}},
        {Std450::pack_snorm_4x8, Std450::unpack_snorm_4x8, {-1, 1, 0, -7}, 0x81007F81, {-1, 1, 0, -1}},
        {Std450::pack_unorm_2x16, Std450::unpack_unorm_2x16, {1, 0.25F}, 0x4000FFFF, {1, 16384.0F / 65535.0F}},
        {Std450::pack_snorm_2x16, Std450::unpack_snorm_2x16, {-1, 1}, 0x7FFF8001, {-1, 1}},
        {Std450::pack_half_2x16, Std450::unpack_half_2x16, {1, -2}, 0xC0003C00, {1, -2}},
    };
    for (const Case& test : cases) {
        SpirvAssembler a;
        const Id type = a.vector(a.real(), static_cast<std::uint32_t>(test.in.size()));
        const Id word = a.extended(test.pack, a.natural(), {vector(a, test.in)});
        a.store(a.output(a.natural(), 1), word);
        a.store(a.output(type, 0), a.extended(test.unpack, type, {word}));
        SpirvRun run(a.module());
        run.run();
        EXPECT_EQ(run.words(1)[3], test.word);
        for (std::uint32_t i = 0; i < test.in.size(); ++i) EXPECT_EQ(run.real(0, i)[2], test.out[i]) << i;
    }
}

} // namespace spirv_composites_test
