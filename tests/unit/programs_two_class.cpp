// Program two-class: the nearest opaque fragment and the nearest transparent one in front of it, whatever the order.
#include "models/kbuffers/library.hpp"
#include "models/programs/two_class.hpp"
#include "sim/random.hpp"
#include "traces/deferred/two_class_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace programs_two_class_test {

using traces::TwoClassSurface;

struct Input {
    float depth = 0.0F, opacity = 1.0F;
    std::uint32_t number = 0; ///< its red, in 255ths
};

using Pixel = std::array<float, 8>;

Pixel after(const std::vector<Input>& fragments) {
    const auto program = models::make_two_class();
    EXPECT_EQ(program->floats_per_pixel(), 8U);
    Pixel pixel{};
    program->clear(pixel.data());
    for (const Input& fragment : fragments) {
        const glm::vec4 words =
            TwoClassSurface{{static_cast<float>(fragment.number) / 255.0F, 0, 0, fragment.opacity}}.words();
        std::array<float, 4> entry{};
        program->make_entry({&words.x, fragment.depth, 0}, entry.data());
        program->insert(pixel.data(), entry.data());
    }
    return pixel;
}

TwoClassSurface transparent(const Pixel& pixel) { return TwoClassSurface::of(pixel.data()); }
TwoClassSurface opaque(const Pixel& pixel) { return TwoClassSurface::of(pixel.data() + 4); }

TEST(TwoClass, EmptyEntriesAreOpaqueAtTheFarPlane) {
    for (const TwoClassSurface& surface : {transparent(after({})), opaque(after({}))}) {
        EXPECT_EQ(surface.depth, 1.0F);
        EXPECT_EQ(surface.colour, glm::vec4(0, 0, 0, 1));
    }
}

TEST(TwoClass, APaneIsKeptInFrontOfTheNearestOpaqueSurfaceOnly) {
    const auto depths = [](const std::vector<Input>& fragments) {
        const Pixel pixel = after(fragments);
        return std::array{transparent(pixel).depth, opaque(pixel).depth};
    };
    EXPECT_EQ(depths({{0.5F, 0.5F}}), (std::array{0.5F, 1.0F}));
    EXPECT_EQ(depths({{0.5F, 0.5F}, {0.6F}}), (std::array{0.5F, 0.6F}));
    EXPECT_EQ(depths({{0.5F, 0.5F}, {0.4F}}), (std::array{1.0F, 0.4F})); // dropped
    EXPECT_EQ(depths({{0.4F}, {0.5F, 0.5F}}), (std::array{1.0F, 0.4F}));
    EXPECT_EQ(depths({{0.5F, 0.5F}, {0.5F}}), (std::array{1.0F, 0.5F})); // not in front of it
    EXPECT_EQ(depths({{0.3F, 0.5F}, {0.2F, 0.1F}, {0.4F, 0.9F}}), (std::array{0.2F, 1.0F}));
    EXPECT_EQ(depths({{1.0F}, {1.0F, 0.5F}}), (std::array{1.0F, 1.0F})); // at the far plane nothing is
}

TEST(TwoClass, OpacityCountsAsEightBitsKeepIt) {
    const auto is_opaque = [](float opacity) { return opaque(after({{0.5F, opacity}})).depth == 0.5F; };
    EXPECT_TRUE(is_opaque(1.0F));
    EXPECT_TRUE(is_opaque(254.6F / 255.0F));
    EXPECT_FALSE(is_opaque(254.4F / 255.0F));
    EXPECT_FALSE(is_opaque(0.0F));
}

TEST(TwoClass, TheOutcomeDoesNotDependOnTheOrder) {
    sim::Random random(7, "fragments");
    for (int stream = 0; stream < 200; ++stream) {
        std::vector<Input> fragments;
        for (std::uint32_t i = 0; i < 12; ++i)
            fragments.push_back({static_cast<float>(i + 1) / 16.0F, random.below(2) == 0 ? 1.0F : 0.25F, i});
        std::vector<Input> sorted = fragments; // by depth
        const auto first =
            std::find_if(sorted.begin(), sorted.end(), [](const Input& of) { return of.opacity == 1.0F; });
        const float nearest = first == sorted.end() ? 1.0F : first->depth;
        const float pane = sorted.front().opacity == 1.0F ? 1.0F : sorted.front().depth;
        for (int order = 0; order < 20; ++order) {
            for (std::size_t i = fragments.size() - 1; i > 0; --i)
                std::swap(fragments[i], fragments[random.below(i + 1)]);
            const Pixel pixel = after(fragments);
            EXPECT_EQ(opaque(pixel).depth, nearest);
            EXPECT_EQ(transparent(pixel).depth, pane);
        }
    }
}

// Sixteen million colours, a thousand million normals: the ends, and their neighbours.
TEST(TwoClass, WordsAreFiniteAndComeBackAsTheGBufferRoundsThem) {
    const std::array values{0.0F, 0.1F / 255.0F, 0.5F, 254.0F / 255.0F, 1.0F, 2.0F, -1.0F};
    for (const float red : values)
        for (const float blue : values)
            for (const float opacity : values) {
                const glm::vec4 colour(red, 0.7F, blue, opacity), normal(blue, red, opacity, 1.0F),
                    specular(opacity, red, 0, 0);
                const glm::vec4 words = TwoClassSurface{colour, normal, specular}.words();
                for (int i = 0; i < 3; ++i) EXPECT_TRUE(std::isfinite(words[i]));
                const std::array<float, 4> entry{words.x, words.y, words.z, 0.5F};
                const TwoClassSurface back = TwoClassSurface::of(entry.data());
                EXPECT_EQ(back.colour, through_format(pipeline::SurfaceFormat::rgba8, colour));
                EXPECT_EQ(glm::vec3(back.normal), glm::vec3(through_format(pipeline::SurfaceFormat::rgb10a2, normal)));
                EXPECT_EQ(back.specular, through_format(pipeline::SurfaceFormat::rgba8, specular));
            }
}

// Peeling and minima know nothing of classes; all else runs it.
TEST(TwoClass, EveryDesignRunsItOrSaysWhyNot) {
    const auto program = models::make_two_class();
    std::vector<std::string> refusing;
    for (const models::DesignInfo& design : models::designs()) {
        sim::Config config;
        if (!design.make(config)->refuses(*program).empty()) refusing.emplace_back(design.id);
    }
    std::sort(refusing.begin(), refusing.end());
    EXPECT_EQ(refusing, (std::vector<std::string>{"atomic-min", "dual-peel", "multipass", "peel-rop"}));
}

} // namespace programs_two_class_test
