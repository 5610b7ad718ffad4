// Draws without shaders, by Mesa and by the shaders that stand for them, pixel by pixel; Mesa runs both.
#include "tests/support/mesa_fixed_function.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fixed_function_test {

namespace {

using namespace traces;
using tests::FixedFunctionMesh;
using tests::MesaFixedFunction;

/// Places of edges, of texels and of steps (alpha test, comparisons) that rounding moves by a pixel.
constexpr double rare = 0.001; ///< of a picture's pixels may differ by more than 1/255
constexpr double rare_in_all = 0.0001;

struct Difference {
    std::uint64_t pixels = 0, differ = 0, drawn = 0;
    int worst = 0;
};

class FixedFunction : public testing::Test {
  protected:
    static void SetUpTestSuite() { mesa_ = MesaFixedFunction::create(reason_).release(); }
    static void TearDownTestSuite() {
        delete mesa_;
        mesa_ = nullptr;
    }
    void SetUp() override {
        if (mesa_ == nullptr) GTEST_SKIP() << "no OpenGL to compare with: " << reason_;
    }

    void compare(const FixedFunctionState& state, const FixedFunctionMesh& mesh, const std::string& name) {
        const FixedFunctionProgram program = fixed_function_program(state);
        const auto expected = mesa_->draw(state, mesh);
        const auto pixels = mesa_->draw(state, program, mesh);
        Difference difference;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            int worst = 0;
            for (int c = 0; c < 4; ++c) worst = std::max(worst, std::abs(int{pixels[i][c]} - int{expected[i][c]}));
            ++difference.pixels;
            difference.differ += worst > 1 ? 1 : 0;
            difference.drawn += expected[i] != glm::u8vec4(51, 102, 153, 204) ? 1 : 0;
            difference.worst = std::max(difference.worst, worst);
        }
        EXPECT_LE(static_cast<double>(difference.differ), rare * static_cast<double>(difference.pixels))
            << name << ": " << difference.differ << " pixels differ by up to " << difference.worst << "/255\n"
            << program.vertex << program.fragment;
        all_.pixels += difference.pixels;
        all_.differ += difference.differ;
        seen_ += difference.drawn > difference.pixels / 20 ? 1 : 0;
    }

    /// The few that differ, and that pictures are not empty.
    void expect_all(std::uint64_t least_seen) const {
        EXPECT_LE(static_cast<double>(all_.differ), rare_in_all * static_cast<double>(all_.pixels));
        EXPECT_GE(seen_, least_seen);
    }

    void compare_states(std::uint64_t first, std::uint64_t last) {
        for (std::uint64_t seed = first; seed < last; ++seed) {
            sim::Random random(seed, "fixed function");
            const FixedFunctionMesh mesh = tests::wavy_square(9, random);
            compare(tests::random_fixed_function(random), mesh, fmt::format("seed {}", seed));
        }
        expect_all((last - first) / 2);
        std::printf("%llu states, %llu of %llu pixels differ\n", static_cast<unsigned long long>(last - first),
                    static_cast<unsigned long long>(all_.differ), static_cast<unsigned long long>(all_.pixels));
    }

    static inline MesaFixedFunction* mesa_ = nullptr;
    static inline std::string reason_;
    Difference all_;
    std::uint64_t seen_ = 0;
};

FixedFunctionState simple_state() {
    FixedFunctionState state;
    state.model_view[3] = glm::vec4(0.0F, 0.0F, -2.5F, 1.0F);
    state.projection[2] = glm::vec4(0.0F, 0.0F, -1.1F, -1.0F);
    state.projection[3] = glm::vec4(0.0F, 0.0F, -1.0F, 0.0F);
    state.projection[0][0] = state.projection[1][1] = 2.0F;
    return state;
}

TEST_F(FixedFunction, EveryEnvironmentOfEveryFormat) {
    sim::Random random(1, "mesh");
    const FixedFunctionMesh mesh = tests::wavy_square(9, random);
    for (const auto environment : {TextureEnvironment::modulate, TextureEnvironment::replace, TextureEnvironment::decal,
                                   TextureEnvironment::blend, TextureEnvironment::add})
        for (int i = 0; i < 8; ++i) {
            FixedFunctionState state = simple_state();
            FixedTextureUnit& unit = state.units[0];
            unit.target = UnitTarget::two_dimensional;
            unit.format = static_cast<BaseFormat>(i);
            unit.environment = environment;
            unit.constant = {0.9F, 0.2F, 0.6F, 0.3F};
            const bool colours = unit.format == BaseFormat::rgb || unit.format == BaseFormat::rgba;
            if (environment == TextureEnvironment::decal && !colours) continue; // undefined
            compare(state, mesh, fmt::format("environment {} of format {}", static_cast<int>(environment), i));
        }
    expect_all(34);
}

TEST_F(FixedFunction, EveryFunctionOfCombiners) {
    sim::Random random(2, "mesh");
    const FixedFunctionMesh mesh = tests::wavy_square(9, random);
    for (int function = 0; function < 8; ++function)
        for (const std::uint8_t scale : {std::uint8_t{1}, std::uint8_t{4}}) {
            FixedFunctionState state = simple_state();
            FixedTextureUnit& unit = state.units[1];
            unit.target = UnitTarget::two_dimensional;
            unit.environment = TextureEnvironment::combine;
            unit.constant = {0.9F, 0.2F, 0.6F, 0.3F};
            unit.colour.function = static_cast<CombineFunction>(function);
            unit.alpha.function = static_cast<CombineFunction>(function % 6);
            unit.colour.arguments[1] = {CombineSource::primary_colour, CombineOperand::one_minus_colour};
            unit.colour.scale = scale;
            unit.alpha.scale = 2;
            compare(state, mesh, fmt::format("function {}, scale {}", function, scale));
        }
    expect_all(16);
}

TEST_F(FixedFunction, StatesByChance) { compare_states(0, 16); }

TEST_F(FixedFunction, LongManyStatesByChance) { compare_states(16, 112); }

} // namespace

} // namespace fixed_function_test
