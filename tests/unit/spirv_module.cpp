// Reading of modules: what is accepted, and the one line that says what is wrong with others.
#include "tests/support/spirv_assembler.hpp"

#include "sim/check.hpp"

#include <cstdint>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace spirv_module_test {

namespace {

using tests::SpirvAssembler;
using tests::SpirvRun;
using traces::spirv::Op;
using traces::spirv::Std450;
using traces::spirv::Storage;
using Id = SpirvAssembler::Id;
using Words = SpirvAssembler::Words;

std::string error_of(const Words& words) {
    try {
        const SpirvRun run(words);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return "";
}

void expect_error(const SpirvAssembler& a, const std::string& part) {
    const std::string error = error_of(a.module());
    EXPECT_EQ(error.find("SPIR-V, word "), 0U) << error;
    EXPECT_NE(error.find(part), std::string::npos) << error;
}

/// A bit of everything: arrays, a uniform block, a loop, a call, a switch, a texture, discard.
Words rich_module() {
    SpirvAssembler a;
    const Id real = a.real(), whole = a.whole(), v4 = a.vector(real, 4), array = a.array(real, 4);
    const Id structure = a.structure({v4, a.array_with_stride(real, 4, 16)});
    constexpr std::uint32_t offset = 35;
    a.decorate_member(structure, 0, offset, {0});
    a.decorate_member(structure, 1, offset, {16});
    a.name_member(structure, 0, "colour");
    const Id block = a.block(structure, "Block"), image = a.sampled_image(1), texture = a.uniform(image, "t");
    const Id input = a.input(v4, 0), output = a.output(v4, 0), function = a.id();
    const Id list =
        a.local(array, a.composite(array, {a.constant(1.0F), a.constant(2.0F), a.constant(3.0F), a.constant(4.0F)}));
    const Id x = a.load(input, v4), first = a.result(Op::composite_extract, real, {x, 0});
    const Id index = a.result(Op::convert_float_to_signed, whole, {first});
    const Id entry = a.id(), header = a.id(), inside = a.id(), next = a.id(), merge = a.id(), i = a.id(),
             following = a.id();
    a.write(Op::branch, {entry});
    a.label(entry);
    a.write(Op::branch, {header});
    a.label(header);
    a.write(Op::phi, {whole, i, a.constant(0), entry, following, next});
    const Id goes_on = a.result(Op::s_less_than, a.truth(), {i, index});
    a.write(Op::loop_merge, {merge, next, 0});
    a.write(Op::branch_conditional, {goes_on, inside, merge});
    a.label(inside);
    const Id place = a.result(Op::access_chain, a.pointer(Storage::function, real), {list, i});
    a.store(place, a.result(Op::function_call, real, {function, a.load(place, real), i}));
    a.write(Op::branch, {next});
    a.label(next);
    a.write(Op::i_add, {whole, following, i, a.constant(1)});
    a.write(Op::branch, {header});
    a.label(merge);
    const Id kill = a.id(), rest = a.id();
    a.write(Op::selection_merge, {rest, 0});
    a.write(Op::branch_conditional, {a.result(Op::f_ord_less_than, a.truth(), {first, a.constant(0.0F)}), kill, rest});
    a.label(kill);
    a.write(Op::kill, {});
    a.label(rest);
    const Id colour = a.load(a.result(Op::access_chain, a.pointer(Storage::uniform, v4), {block, a.constant(0)}), v4);
    const Id weight =
        a.load(a.result(Op::access_chain, a.pointer(Storage::uniform, real), {block, a.constant(1), index}), real);
    const Id uv = a.result(Op::vector_shuffle, a.vector(real, 2), {x, x, 1, 6});
    const Id texel = a.result(Op::image_sample_implicit_lod, v4, {a.load(texture, image), uv});
    const Id sum = a.result(Op::f_add, v4, {a.result(Op::f_mul, v4, {texel, colour}), a.load(input, v4)});
    const Id scaled = a.result(Op::vector_times_scalar, v4, {a.extended(Std450::normalize, v4, {sum}), weight});
    const Id element = a.load(a.result(Op::access_chain, a.pointer(Storage::function, real), {list, index}), real);
    a.store(output, a.result(Op::composite_insert, v4, {element, scaled, 3}));
    const auto parameters = a.begin_function(function, real, {real, whole});
    const Id one = a.id(), otherwise = a.id(), end = a.id();
    a.write(Op::selection_merge, {end, 0});
    a.write(Op::switch_case, {parameters[1], otherwise, 1, one});
    a.label(one);
    a.write(Op::return_value, {a.extended(Std450::pow, real, {parameters[0], a.constant(2.0F)})});
    a.label(otherwise);
    a.write(Op::branch, {end});
    a.label(end);
    a.write(Op::return_value, {a.result(Op::f_add, real, {parameters[0], a.constant(1.0F)})});
    a.end_function();
    return a.module();
}

/// What anything may lead to: a result, or one line.
bool refuses(const Words& words) {
    constexpr std::uint64_t budget = 2000;
    try {
        SpirvRun run(words, budget);
        for (const auto& input : run.program.inputs)
            for (std::uint32_t i = 0; i < input.components * input.columns * input.elements; ++i)
                run.quad.set(input, i, {0.5F, 3.0F, -1.0F, 1e9F});
        run.run();
        return false;
    } catch (const sim::InputError& error) {
        const std::string text = error.what();
        EXPECT_EQ(text.find("SPIR-V"), 0U) << text;
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        return true;
    }
}

} // namespace

TEST(SpirvModule, VersionNoughtIsAccepted) {
    SpirvAssembler a;
    Words words = a.module();
    words[1] = 0;
    EXPECT_EQ(error_of(words), "");
}

TEST(SpirvModule, HeadersAreChecked) {
    const Words good = SpirvAssembler().module();
    const auto with = [&](std::size_t word, std::uint32_t value) {
        Words words = good;
        words[word] = value;
        return error_of(words);
    };
    EXPECT_EQ(error_of({}), "SPIR-V, word 0: expected a header of five words, got 0");
    EXPECT_EQ(with(0, 0x03022307), "SPIR-V, word 0: expected the magic number 0x7230203, got 0x3022307");
    EXPECT_EQ(with(1, 0x20000), "SPIR-V, word 1: expected version 1.0 to 1.6, got 0x20000");
    EXPECT_NE(with(3, 0).find("SPIR-V, word 3: expected 1 to "), std::string::npos);
    EXPECT_NE(with(3, 0xFFFFFFFF).find("SPIR-V, word 3: expected 1 to "), std::string::npos);
    EXPECT_EQ(with(5, 0x01000011),
              "SPIR-V, word 5 (OpCapability): expected 1 to " + std::to_string(good.size() - 5) + " words, got 256");
}

TEST(SpirvModule, ErrorsNameWordAndInstruction) {
    SpirvAssembler a;
    a.load(a.constant(1.0F), a.real());
    expect_error(a, "(OpLoad): expected id");
    SpirvAssembler b;
    b.result(Op::f_add, b.real(), {b.constant(1.0F), b.constant(1)});
    expect_error(b, "(OpFAdd): expected id");
    SpirvAssembler c;
    c.result(Op::f_add, c.vector(c.real(), 3), {c.constant(1.0F), c.constant(1.0F)});
    expect_error(c, "to be 3 floats, got 1 of another type or number");
    SpirvAssembler d;
    d.result(Op::dot, d.real(), {d.id(), d.id()});
    expect_error(d, "to be defined before it is used");
    SpirvAssembler e;
    e.array(e.real(), 1U << 30U);
    expect_error(e, "(OpTypeArray): expected an array of 1 to 65536 elements");
    SpirvAssembler f;
    f.write(Op::branch, {f.id()});
    EXPECT_NE(error_of(f.module(false)).find("(OpBranch): expected id"), std::string::npos)
        << error_of(f.module(false));
    SpirvAssembler g;
    g.write(static_cast<Op>(99 + 200), {1, 2});
    expect_error(g, "(opcode 299): not an instruction that is modelled");
}

TEST(SpirvModule, TypesNestedTooDeepAreRefused) {
    SpirvAssembler a;
    Id type = a.real();
    for (int i = 0; i < 100; ++i) type = a.structure({type});
    expect_error(a, "nested too deep");
    SpirvAssembler b;
    Id large = b.real();
    for (int i = 0; i < 5; ++i) large = b.array(large, 64);
    expect_error(b, "expected an array of 1 to");
}

TEST(SpirvModule, TheRichOneRuns) {
    SpirvRun run(rich_module());
    run.quad.set(run.input(0), 0, {2.5F, 0, 3, -1});
    run.run();
    EXPECT_EQ(run.quad.alive(), 0b0111U);
    EXPECT_EQ(run.real(0, 3)[0], 3); // element 2, not yet reached by the loop
    EXPECT_EQ(run.real(0, 3)[1], 1);
    EXPECT_EQ(run.real(0, 3)[2], 4);
}

TEST(SpirvModule, TruncatedAnywhereItIsRefusedOrRuns) {
    const Words words = rich_module();
    std::size_t refused = 0;
    for (std::size_t length = 0; length < words.size(); ++length)
        refused += refuses(Words(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(length))) ? 1 : 0;
    EXPECT_EQ(refused, words.size()); // the last word ends a function
}

TEST(SpirvModule, WithAnyBitFlippedItIsRefusedOrRuns) {
    const Words words = rich_module();
    std::size_t refused = 0;
    for (std::size_t word = 0; word < words.size(); ++word)
        for (unsigned bit = 0; bit < 32; ++bit) {
            Words flipped = words;
            flipped[word] ^= 1U << bit;
            refused += refuses(flipped) ? 1 : 0;
        }
    EXPECT_GT(refused, words.size() * 16); // most bits matter
}

TEST(SpirvModule, WithAnyWordReplacedItIsRefusedOrRuns) {
    const Words words = rich_module();
    for (std::size_t word = 0; word < words.size(); ++word)
        for (const std::uint32_t value : {0U, 1U, words[3] - 1, words[3], 0x7FFFFFFFU, 0xFFFFFFFFU, words[word] + 1,
                                          words[(word + 7) % words.size()]}) {
            Words changed = words;
            changed[word] = value;
            refuses(changed);
        }
}

} // namespace spirv_module_test
