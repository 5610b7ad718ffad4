// The k-buffer language: what programs in it compute, and that A6 and A7 in it are the built-in programs.
#include "models/programs/language/user_program.hpp"
#include "models/programs/nearest_k.hpp"
#include "models/programs/order_and_blend.hpp"
#include "sim/random.hpp"
#include "tests/support/paths.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
#include <vector>

namespace {

using pipeline::ModifyProgram;

models::ProgramChoice program_of(const std::string& text, std::uint32_t k = 0) {
    return models::user_program("test.kb", text, k);
}

/// The state s.x after one fragment (r, g, b, a, z, object = 0.5, 0.25, 0.75, 1, 0.125, 3), or after the drain.
float result(const std::string& body, const std::string& header = "", const std::string& drain = "") {
    const auto program = program_of(fmt::format("program \"t\"; k 3; entry r, g, z, o = f.object; {} state x = 7; "
                                                "fragment {{ {} }} {}",
                                                header, body, drain))
                             .program;
    std::vector<float> pixel(program->floats_per_pixel());
    program->clear(pixel.data());
    const std::array<float, 4> rgba{0.5F, 0.25F, 0.75F, 1.0F};
    std::array<float, pipeline::largest_entry> entry{};
    program->make_entry({rgba.data(), 0.125F, 3}, entry.data());
    program->insert(pixel.data(), entry.data());
    program->drain(pixel.data());
    return pixel[3 * 4];
}

TEST(Language, Arithmetic) {
    EXPECT_EQ(result("s.x = 1 + 2 * 3;"), 7.0F);
    EXPECT_EQ(result("s.x = (1 + 2) * 3 - 4;"), 5.0F);
    EXPECT_EQ(result("s.x = f.r + f.g * f.z;"), 0.5F + 0.25F * 0.125F);
    EXPECT_EQ(result("s.x = 8 - 4 - 2;"), 2.0F);
    EXPECT_EQ(result("s.x = f.o / f.r / 2.0;"), 3.0F);
    EXPECT_EQ(result("s.x = -f.r - -f.g;"), -0.25F);
    EXPECT_EQ(result("s.x = min(f.r, f.g) + max(f.r, f.g) + abs(f.g - f.r);"), 1.0F);
    EXPECT_EQ(result("s.x = select(f.r < f.g, 1.0, select(f.o == 3, 2.0, 3.0));"), 2.0F);
}

// Sums side by side that share a factor become one instruction, which does them one after the other all the same.
TEST(Language, SumsOfProductsAreDoneInTheirOrder) {
    const auto sums = [&](const std::string& body) {
        const auto program =
            program_of("program \"t\"; k 4; entry r, g, b, z; state x = 7, y = 2, u = 3; fragment {" + body + "}")
                .program;
        std::vector<float> pixel(program->floats_per_pixel());
        program->clear(pixel.data());
        const std::array<float, 4> entry{0.5F, 0.25F, 0.75F, 0.125F};
        program->insert(pixel.data(), entry.data());
        return std::array{pixel[16], pixel[17], pixel[18]};
    };
    using Sums = std::array<float, 3>;
    const Sums scaled{7.0F + 0.125F * 0.5F, 2.0F + 0.125F * 0.25F, 3.0F + 0.125F * 0.75F};
    EXPECT_EQ(sums("s.x = s.x + f.z * f.r; s.y = s.y + f.z * f.g; s.u = s.u + f.z * f.b;"), scaled);
    EXPECT_EQ(sums("s.x = s.x + f.r * f.z; s.y = s.y + f.z * f.g; s.u = s.u + f.b * f.z;"), scaled);
    // The shared factor is one of the sums.
    EXPECT_EQ(sums("s.x = s.x + s.y * f.r; s.y = s.y + s.y * f.g; s.u = s.u + s.y * f.b;"),
              (Sums{8.0F, 2.5F, 3.0F + 2.5F * 0.75F}));
    // A jump between them.
    EXPECT_EQ(sums("if f.r < f.g { s.x = s.x + f.z * f.r; } s.y = s.y + f.z * f.g;"), (Sums{7.0F, scaled[1], 3.0F}));
    EXPECT_EQ(sums("s.x = s.x + f.z * f.r; if f.r < f.g { s.y = s.y + f.z * f.g; }"), (Sums{scaled[0], 2.0F, 3.0F}));
}

TEST(Language, WholeNumbersStayWhole) {
    EXPECT_EQ(result("s.x = 7 / 2;"), 3.0F);
    EXPECT_EQ(result("int n = int(f.o); s.x = n / 2 * 2;"), 2.0F);
    EXPECT_EQ(result("int n = int(-f.o / 2.0); s.x = n;"), -1.0F);
    EXPECT_EQ(result("int n = 16777216; n = n * n; s.x = n;"), 16777216.0F);
    EXPECT_EQ(result("int n = int(f.o) * 16777215; s.x = n / 16777216;"), 1.0F);
}

TEST(Language, DivisionByZeroIsZeroOfTheQuotientsSign) {
    for (const char* zero : {"0.0", "(f.r - f.r)"}) {
        EXPECT_EQ(result(fmt::format("s.x = f.r / {};", zero)), 0.0F);
        EXPECT_FALSE(std::signbit(result(fmt::format("s.x = f.r / {};", zero))));
        EXPECT_TRUE(std::signbit(result(fmt::format("s.x = -f.r / {};", zero))));
        EXPECT_TRUE(std::signbit(result(fmt::format("s.x = f.r / -{};", zero))));
        EXPECT_FALSE(std::signbit(result(fmt::format("s.x = {} / {};", zero, zero))));
    }
    EXPECT_EQ(result("int n = int(f.o); s.x = n / (n - n);"), 0.0F);
}

TEST(Language, ResultsAreFinite) {
    constexpr float largest = std::numeric_limits<float>::max();
    EXPECT_EQ(result("s.x = largest + largest;"), largest);
    EXPECT_EQ(result("float a = largest * f.r; s.x = a * -8.0;"), -largest);
    EXPECT_EQ(result("float a = largest * f.r; s.x = a * 8.0 - a * 8.0;"), 0.0F);
    EXPECT_EQ(result("float a = largest * f.r; s.x = a / f.z;"), largest);
    EXPECT_EQ(result("float a = largest * f.r; s.x = f.r + a * 8.0;"), largest);
}

TEST(Language, LogicAndBranches) {
    EXPECT_EQ(result("if f.r > f.g and not f.g >= f.r or false { s.x = 1; } else { s.x = 2; }"), 1.0F);
    EXPECT_EQ(result("bool b = f.r < f.g; if b { s.x = 1; } else if f.o != 3 { s.x = 2; } else { s.x = 3; }"), 3.0F);
    EXPECT_EQ(result("bool b = f.r < f.g; b = b == false; if b { s.x = 1; }"), 1.0F);
    EXPECT_EQ(result("if k == 3 { s.x = 1; } else { s.x = 2; }"), 1.0F);
    EXPECT_EQ(result("if f.r <= 0.5 { if f.g > 0.25 { s.x = 1; } else { s.x = 2; } }"), 2.0F);
}

TEST(Language, LoopsAndEntries) {
    EXPECT_EQ(result("s.x = 0; for i in 0..k { e[i].z = 2 * i; } for i in 0..k { s.x = s.x + e[i].z; }"), 6.0F);
    EXPECT_EQ(result("s.x = 0; for i in 0..2 { for j in i..4 { s.x = s.x + 1; } }"), 7.0F);
    EXPECT_EQ(result("for i in 5..2 { s.x = 0; }"), 7.0F);
    EXPECT_EQ(result("e[1] = f; swap e[1], e[2]; s.x = e[2].g + e[1].g;"), 0.25F);
    EXPECT_EQ(result("float a = 1; float b = 2; swap a, b; s.x = a;"), 2.0F);
}

TEST(Language, ComputedIndicesAreCutToTheEntriesThereAre) {
    const std::string fill = "for i in 0..k { e[i].z = i + 1; } ";
    EXPECT_EQ(result(fill + "int n = int(f.o) - 2; s.x = e[n].z;"), 2.0F);
    EXPECT_EQ(result(fill + "int n = int(f.o) * 100; s.x = e[n].z;"), 3.0F);
    EXPECT_EQ(result(fill + "int n = -int(f.o); s.x = e[n].z;"), 1.0F);
    EXPECT_EQ(result(fill + "int n = int(f.o) - 2; e[n].z = 9; s.x = e[1].z;"), 9.0F);
    EXPECT_EQ(result(fill + "int n = int(f.o) - 2; e[n] = f; s.x = e[1].o;"), 3.0F);
    EXPECT_EQ(result(fill + "int n = int(f.o) - 2; swap e[n], e[0]; s.x = e[0].z * 10 + e[1].z;"), 21.0F);
    EXPECT_EQ(result(fill + "int n = int(f.o) - 2; swap f, e[n]; s.x = f.z * 10 + e[1].o;"), 23.0F);
}

TEST(Language, HeadersSayWhatAPixelHolds) {
    const auto choice =
        program_of("program \"p\" \"text\"; k 2 from 1 to 5; entry r = 1 - f.r, depth = f.z; depth depth; "
                   "empty depth = half + 1; constant half = 0.5; state t = half * 2, u = k; order any; "
                   "peeling nearest; fragment { e[0] = f; }",
                   5);
    const ModifyProgram& program = *choice.program;
    EXPECT_EQ(program.id(), "p");
    EXPECT_EQ(program.summary(), "text");
    EXPECT_EQ(program.k(), 5U);
    EXPECT_EQ(program.floats_per_entry(), 2U);
    EXPECT_EQ(program.state_floats(), 2U);
    EXPECT_EQ(program.depth_slot(), 1U);
    EXPECT_EQ(program.order_need(), pipeline::OrderNeed::any);
    EXPECT_EQ(program.peeling(), pipeline::Peeling::nearest);
    EXPECT_TRUE(program.needs_colour());
    EXPECT_FALSE(program.needs_texture());
    EXPECT_FALSE(program.drains());
    EXPECT_EQ(choice.picture, nullptr);
    std::vector<float> pixel(program.floats_per_pixel());
    program.clear(pixel.data());
    EXPECT_EQ(pixel, (std::vector<float>{0, 1.5F, 0, 1.5F, 0, 1.5F, 0, 1.5F, 0, 1.5F, 1, 5}));
}

TEST(Language, DepthsAloneNeedNoColour) {
    const auto program = program_of("program \"p\"; entry z; fragment { e[0] = f; }").program;
    EXPECT_FALSE(program->needs_colour());
    float entry = 0.0F;
    program->make_entry({nullptr, 0.25F, 0}, &entry);
    EXPECT_EQ(entry, 0.25F);
}

TEST(Language, DrainSeesThePixelAfterTheLastFragment) {
    EXPECT_EQ(result("s.x = f.r;", "", "drain { s.x = s.x * 4; }"), 2.0F);
}

TEST(Language, ConstantsCanBeSetFromOutside) {
    const std::string text = "program \"p\"; entry z; constant opacity = 0.5, other = opacity + 1; state x = other; "
                             "fragment { e[0] = f; }";
    const auto program = models::user_program("p.kb", text, 1, {{"opacity", 0.25F}, {"unknown", 1.0F}}).program;
    std::vector<float> pixel(program->floats_per_pixel());
    program->clear(pixel.data());
    EXPECT_EQ(pixel[1], 1.25F);
}

TEST(Language, CostIsTheLongestPath) {
    const auto cost = [](const std::string& body) {
        return program_of(fmt::format("program \"p\"; k 4; entry r, z; state x = 0; fragment {{ {} }}", body))
            .program->cost()
            .operations;
    };
    EXPECT_EQ(cost(""), 0U);
    EXPECT_EQ(cost("s.x = f.r;"), 1U);
    EXPECT_EQ(cost("s.x = f.r + 1;"), 1U);
    EXPECT_EQ(cost("s.x = f.r + f.z * f.z;"), 2U);
    EXPECT_EQ(cost("e[0] = f;"), 2U);
    EXPECT_EQ(cost("swap e[0], f;"), 4U);
    EXPECT_EQ(cost("for i in 0..k { if f.z < e[i].z { swap f, e[i]; } }"), 4U * 5);
    EXPECT_EQ(cost("if f.z < 0.5 { s.x = f.r; } else { e[0] = f; }"), 1U + 2);
    EXPECT_EQ(cost("if f.z < 0.5 and f.r > 0.5 { s.x = f.r; }"), 3U + 1);
    EXPECT_EQ(cost("if k > 2 { s.x = f.r; } else { e[0] = f; e[1] = f; }"), 1U);
}

struct Pair {
    std::shared_ptr<const ModifyProgram> built_in, written;
};

Pair nearest_k(std::uint32_t k) {
    return {models::make_nearest_k(models::EntryKind::rgbz, k), models::load_user_program("nearest_k.kb", k).program};
}

Pair order_and_blend(std::uint32_t k) {
    return {models::make_order_and_blend(k, 0.3F),
            models::load_user_program("order_and_blend.kb", k, {{"opacity", 0.3F}}).program};
}

void expect_same_pixels(const Pair& pair) {
    sim::Random random(pair.built_in->k(), "fragments");
    std::vector<float> a(pair.built_in->floats_per_pixel()), b(pair.written->floats_per_pixel());
    ASSERT_EQ(a.size(), b.size());
    for (int pixel = 0; pixel < 40; ++pixel) {
        pair.built_in->clear(a.data());
        pair.written->clear(b.data());
        for (int i = 0; i < 30; ++i) {
            ASSERT_EQ(a, b);
            std::array<float, 4> rgba;
            for (float& channel : rgba) channel = static_cast<float>(random.uniform());
            const float depth = static_cast<float>(random.below(24)) / 24.0F; // ties are frequent
            std::array<float, 4> entry_a{}, entry_b{};
            pair.built_in->make_entry({rgba.data(), depth, 0}, entry_a.data());
            pair.written->make_entry({rgba.data(), depth, 0}, entry_b.data());
            ASSERT_EQ(entry_a, entry_b);
            const bool changed = pair.built_in->insert(a.data(), entry_a.data());
            ASSERT_EQ(pair.written->insert(b.data(), entry_b.data()), changed);
        }
        pair.built_in->drain(a.data());
        pair.written->drain(b.data());
        ASSERT_EQ(a, b);
    }
}

/// The first block of the README whose first line begins with that.
std::string readme_block(const std::string& beginning) {
    std::ifstream stream(ropsim_test::source_dir() / "models/programs/README.md");
    const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    const std::size_t begin = text.find("```\n" + beginning);
    if (begin == std::string::npos) return {};
    return text.substr(begin + 4, text.find("```", begin + 4) - begin - 4);
}

TEST(Language, TheReadmesExampleDoesWhatTheReadmeSays) {
    const auto program = program_of(readme_block("program \"range\"")).program;
    EXPECT_EQ(program->k(), 1U);
    EXPECT_EQ(program->cost().operations, 7U);
    std::vector<float> pixel(program->floats_per_pixel());
    program->clear(pixel.data());
    const std::array<float, 4> rgba{0.5F, 0.25F, 0.75F, 1.0F};
    std::array<float, pipeline::largest_entry> entry{};
    for (const float depth : {0.5F, 0.25F, 0.75F}) {
        program->make_entry({rgba.data(), depth, 0}, entry.data());
        EXPECT_TRUE(program->insert(pixel.data(), entry.data()));
    }
    const float nearest = pixel[3], farthest = pixel[4], count = pixel[5];
    EXPECT_EQ(nearest, 0.25F);
    EXPECT_EQ(farthest, 0.75F);
    EXPECT_EQ(count, 3.0F);
}

TEST(Language, A6AndA7AreTheBuiltInPrograms) {
    for (const std::uint32_t k : {1U, 2U, 4U, 16U, 63U})
        for (const Pair& pair : {nearest_k(k), order_and_blend(k)}) {
            SCOPED_TRACE(fmt::format("{} k = {}", pair.built_in->id(), k));
            EXPECT_EQ(pair.written->id(), pair.built_in->id());
            EXPECT_EQ(pair.written->cost().operations, pair.built_in->cost().operations);
            EXPECT_EQ(pair.written->targets(), pair.built_in->targets());
            EXPECT_EQ(pair.written->order_need(), pair.built_in->order_need());
            EXPECT_EQ(pair.written->peeling(), pair.built_in->peeling());
            EXPECT_EQ(pair.written->drains(), pair.built_in->drains());
            EXPECT_EQ(pair.written->needs_colour(), pair.built_in->needs_colour());
            expect_same_pixels(pair);
        }
}

} // namespace
