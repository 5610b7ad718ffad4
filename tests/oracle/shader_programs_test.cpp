// Modify programs in GLSL: those of specification 004 give the pixels of the built-in ones, bit for bit.
#include "models/programs/nearest_k.hpp"
#include "models/programs/order_and_blend.hpp"
#include "sim/check.hpp"
#include "sim/random.hpp"
#include "sim/read_file.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/spirv_compiler.hpp"
#include "traces/shader_programs/program.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <limits>

namespace shader_programs_test {

namespace {

using pipeline::ModifyProgram;

std::vector<std::uint32_t> compile(const std::string& source, const std::string& name) {
    tests::CompiledSpirv spirv = tests::compile_fragment_shader(source);
    if (!spirv.problem.empty()) throw sim::InputError(name + ": " + spirv.problem);
    return spirv.optimised;
}

models::ProgramChoice shipped(const std::string& file, std::uint32_t k, float opacity) {
    const auto path = ropsim_test::source_dir() / "models/programs" / file;
    return traces::shader_program(file, sim::read_file(path, 1U << 20), k, opacity, compile);
}

class ShaderPrograms : public testing::Test {
  protected:
    void SetUp() override {
        const std::string problem = tests::compile_fragment_shader("#version 450\nvoid main() {}\n").problem;
        if (!problem.empty()) GTEST_SKIP() << problem;
    }
};

/// One of the built-in programs and its text.
struct Pair {
    std::shared_ptr<const ModifyProgram> built_in, written;
};

std::vector<Pair> pairs(std::uint32_t k) {
    return {{models::make_nearest_k(models::EntryKind::rgbz, k), shipped("nearest_k.glsl", k, 0.3F).program},
            {models::make_order_and_blend(k, 0.3F), shipped("order_and_blend.glsl", k, 0.3F).program}};
}

/// That both do the same with fragments by chance.
void expect_alike(const Pair& pair, std::uint32_t k) {
    SCOPED_TRACE(fmt::format("{} k = {}", pair.built_in->id(), k));
    EXPECT_EQ(pair.written->id(), pair.built_in->id());
    EXPECT_EQ(pair.written->summary(), pair.built_in->summary());
    EXPECT_EQ(pair.written->order_need(), pair.built_in->order_need());
    EXPECT_EQ(pair.written->peeling(), pair.built_in->peeling());
    EXPECT_EQ(pair.written->drains(), pair.built_in->drains());
    EXPECT_EQ(pair.written->needs_colour(), pair.built_in->needs_colour());
    EXPECT_EQ(pair.written->cleared_depth(), pair.built_in->cleared_depth());
    sim::Random random(k, "fragments");
    std::vector<float> a(pair.built_in->floats_per_pixel()), b(pair.written->floats_per_pixel());
    ASSERT_EQ(a.size(), b.size());
    for (int pixel = 0; pixel < 20; ++pixel) {
        pair.built_in->clear(a.data());
        pair.written->clear(b.data());
        for (int i = 0; i < 30; ++i) {
            ASSERT_EQ(a, b);
            std::array<float, 4> rgba{};
            for (float& channel : rgba) channel = static_cast<float>(random.uniform());
            const float depth = static_cast<float>(random.below(24)) / 24.0F; // ties are frequent
            std::array<float, 4> entry_a{}, entry_b{};
            pair.built_in->make_entry({rgba.data(), depth, 0}, entry_a.data());
            pair.written->make_entry({rgba.data(), depth, 0}, entry_b.data());
            ASSERT_EQ(entry_a, entry_b);
            const std::vector<float> before = b;
            pair.built_in->insert(a.data(), entry_a.data());
            const bool changed = pair.written->insert(b.data(), entry_b.data());
            ASSERT_EQ(changed, b != before);
        }
        pair.built_in->drain(a.data());
        pair.written->drain(b.data());
        ASSERT_EQ(a, b);
    }
}

TEST_F(ShaderPrograms, LongA6AndA7AreTheBuiltInPrograms) {
    for (const std::uint32_t k : {1U, 2U, 4U})
        for (const Pair& pair : pairs(k)) expect_alike(pair, k);
}

TEST_F(ShaderPrograms, LongA6AndA7WithSixteenEntriesAreTheBuiltInPrograms) {
    for (const Pair& pair : pairs(16)) expect_alike(pair, 16);
}

/// The program that the README of the programs shows.
std::string readme_example() {
    const std::string text = sim::read_file(ropsim_test::source_dir() / "models/programs/README.md", 1U << 20);
    const std::size_t begin = text.find("```\n#pragma program \"range\"");
    return begin == std::string::npos ? "" : text.substr(begin + 4, text.find("```", begin + 4) - begin - 4);
}

TEST_F(ShaderPrograms, TheReadmesExampleDoesWhatTheReadmeSays) {
    const auto program = traces::shader_program("range.glsl", readme_example(), 0, 0.5F, compile).program;
    EXPECT_EQ(program->k(), 1U);
    std::vector<float> pixel(program->floats_per_pixel());
    program->clear(pixel.data());
    const std::array<float, 4> rgba{0.5F, 0.25F, 0.75F, 1.0F};
    std::array<float, pipeline::largest_entry> entry{};
    for (const float depth : {0.5F, 0.25F, 0.75F}) {
        program->make_entry({rgba.data(), depth, 0}, entry.data());
        EXPECT_TRUE(program->insert(pixel.data(), entry.data()));
    }
    EXPECT_EQ(pixel, (std::vector<float>{0.5F, 0.25F, 0.75F, 0.25F, 0.75F, 3.0F, 0.0F, 0.0F}));
}

/// A program of one entry whose function does this.
std::string with_body(const std::string& body) {
    return "#pragma program \"mine\"\nstruct Entry { float z; };\nstruct State { float n; };\n"
           "Entry entry(Fragment f) { return Entry(f.depth); }\nEntry empty() { return Entry(largest); }\n"
           "State initial() { return State(7.0); }\n"
           "void modify(inout Entry e[k], inout State s, Entry f) {\n" +
           body + "\n}\n";
}

models::ProgramChoice mine(const std::string& body, std::uint32_t k = 1) {
    return traces::shader_program("mine.glsl", with_body(body), k, 0.5F, compile);
}

std::string problem_of(const std::string& body) {
    try {
        mine(body);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return "";
}

TEST_F(ShaderPrograms, LongPriceGrowsWithWhatAFragmentNeeds) {
    const std::uint32_t nothing = mine("").program->cost().operations;
    const std::uint32_t sum = mine("s.n = s.n + f.z * 2.0;").program->cost().operations;
    const std::uint32_t branch = mine("if (f.z < e[0].z) { e[0] = f; s.n += sqrt(f.z); }").program->cost().operations;
    EXPECT_LE(nothing, 2U);
    EXPECT_GT(sum, nothing);
    EXPECT_GT(branch, sum);
    const auto nearest = [](std::uint32_t k) { return shipped("nearest_k.glsl", k, 0.5F).program->cost().operations; };
    EXPECT_GT(nearest(4), nearest(2));
    EXPECT_GT(nearest(2), nearest(1));
}

TEST_F(ShaderPrograms, StoreFiniteFloats) {
    const auto program = mine("s.n = s.n / 0.0; e[0].z = s.n - s.n;").program;
    std::vector<float> pixel(program->floats_per_pixel());
    program->clear(pixel.data());
    EXPECT_EQ(pixel[1], 7.0F);
    const float entry = 0.5F;
    EXPECT_TRUE(program->insert(pixel.data(), &entry));
    for (const float stored : pixel) EXPECT_TRUE(std::isfinite(stored));
    EXPECT_EQ(pixel[1], std::numeric_limits<float>::max());
}

TEST_F(ShaderPrograms, ErrorsAreToldWithTheProgramsName) {
    EXPECT_EQ(problem_of("while (f.z < 2.0) s.n = 1.0 - s.n;"),
              "mine.glsl: a fragment takes more than 65536 instructions; expected loops that end");
    EXPECT_NE(problem_of("\n\ns.n = nothing;").find("mine.glsl"), std::string::npos);
    EXPECT_NE(problem_of("\n\ns.n = nothing;").find("10"), std::string::npos); // the line
    EXPECT_EQ(problem_of("discard;"), "mine.glsl: expected a program without discard");
    try {
        traces::shader_program("mine.glsl", with_body(""), 65, 0.5F, compile);
        FAIL();
    } catch (const sim::InputError& error) {
        EXPECT_STREQ(error.what(), "mine.glsl: k: expected 1 to 64, got 65");
    }
}

} // namespace

} // namespace shader_programs_test
