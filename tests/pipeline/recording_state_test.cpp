// State of recorded draws: alpha tests, depth ranges, levels and planes that are drawn to, blits, the time of vertex
// shaders.
#include "sim/check.hpp"
#include "tests/support/drawn_recording.hpp"
#include "tests/support/spirv_assembler.hpp"

#include <functional>
#include <gtest/gtest.h>

namespace recording_state_test {

using namespace drawn_recording;
using pipeline::Compare;
using pipeline::PixelRectangle;
using pipeline::SurfaceFormat;
using tests::RecordedFrames;
using tests::SpirvAssembler;
using Shade = RecordedFrames::Shade;
using Id = SpirvAssembler::Id;

bool is_drawn(SurfaceFormat format, float alpha, Compare compare, float reference) {
    RecordedFrames frames(width, height);
    frames.recording.surfaces[0].format = format;
    frames.clear(blue);
    auto& draw = frames.draw(RecordedFrames::everything({1, 0, 0, alpha}));
    draw.alpha_test = compare;
    draw.alpha_reference = reference;
    return Drawn(frames.recording).at(3, 3).r == 1.0F;
}

TEST(RecordingState, AlphaTestsCompareTheStepsOfTheTarget) {
    constexpr float above = 100.4F / 255.0F, below = 99.6F / 255.0F; // both are stored as 100
    EXPECT_TRUE(is_drawn(SurfaceFormat::rgba8, above, Compare::equal, below));
    EXPECT_FALSE(is_drawn(SurfaceFormat::rgba8, above, Compare::greater, below));
    EXPECT_TRUE(is_drawn(SurfaceFormat::srgb8a8, above, Compare::equal, below));
    EXPECT_FALSE(is_drawn(SurfaceFormat::rgba16, above, Compare::equal, below));
    EXPECT_FALSE(is_drawn(SurfaceFormat::rgba32f, above, Compare::equal, below));
    EXPECT_TRUE(is_drawn(SurfaceFormat::rgba32f, above, Compare::greater, below));
    EXPECT_TRUE(is_drawn(SurfaceFormat::rgb10a2, 0.4F, Compare::equal, 0.3F)); // of three steps the first
    EXPECT_FALSE(is_drawn(SurfaceFormat::rgb10a2, 0.4F, Compare::equal, 0.1F));
}

TEST(RecordingState, AlphaTestsOfFixedPointTargetsClampTheReference) {
    EXPECT_TRUE(is_drawn(SurfaceFormat::rgba8, 1.0F, Compare::greater_equal, 1.5F));
    EXPECT_FALSE(is_drawn(SurfaceFormat::rgba32f, 1.0F, Compare::greater_equal, 1.5F));
    EXPECT_TRUE(is_drawn(SurfaceFormat::rgba8, 0.0F, Compare::less_equal, -0.5F));
}

RasterState ranged(float at_near, float at_far) {
    RasterState state = depth_tested();
    state.depth.range_near = at_near;
    state.depth.range_far = at_far;
    return state;
}

TEST(RecordingState, DepthRangesPlaceWhatIsDrawn) {
    RecordedFrames frames(width, height);
    frames.clear(black);
    frames.draw(RecordedFrames::everything(red, 0.9F), Shade::colour, frames.add_state(ranged(0.0F, 0.5F))); // 0.45
    frames.draw(RecordedFrames::rectangle({-1, -1}, {0, 1}, green, 0.6F), Shade::colour,
                frames.add_state(depth_tested()));
    EXPECT_EQ(Drawn(frames.recording).at(2, 3), red);
    frames.draw(RecordedFrames::rectangle({-1, -1}, {0, 1}, blue, 0.7F), Shade::colour,
                frames.add_state(ranged(1.0F, 0.0F))); // 0.3
    const Drawn drawn(frames.recording);
    EXPECT_EQ(drawn.at(2, 3), blue);
    EXPECT_EQ(drawn.at(20, 3), red);
    const pipeline::RunResult result = run(drawn, "existing");
    EXPECT_EQ(result.colour, drawn.image.colour);
}

TEST(RecordingState, ShadersSeeDepthsWithinTheRange) {
    RecordedFrames frames(width, height);
    frames.recording.surfaces[0].format = SurfaceFormat::rgba32f;
    frames.clear(black);
    frames.draw(RecordedFrames::everything(red, 0.25F), Shade::places, frames.add_state(ranged(0.5F, 1.0F)));
    EXPECT_EQ(Drawn(frames.recording).at(3, 3).b, 1.0F - 0.625F);
}

std::vector<std::byte> texels_of(const glm::vec4& colour, std::size_t count) {
    std::vector<std::byte> bytes;
    for (std::size_t i = 0; i < count; ++i)
        for (int channel = 0; channel < 4; ++channel)
            bytes.push_back(colour[channel] > 0.5F ? std::byte{255} : std::byte{0});
    return bytes;
}

/// A target set of one level of one plane; rows as those of textures.
std::uint32_t add_part(RecordedFrames& frames, const traces::TargetSet::Target& target, std::uint32_t side) {
    traces::TargetSet set;
    set.colours = {target};
    set.width = set.height = side;
    set.top_row_first = false;
    frames.recording.targets.push_back(set);
    return static_cast<std::uint32_t>(frames.recording.targets.size() - 1);
}

std::uint32_t bind_levels(RecordedFrames& frames, std::uint32_t surface, std::uint32_t base, std::uint32_t last) {
    const std::uint32_t set = frames.bind(surface);
    frames.recording.bindings[set][0].base_level = base;
    frames.recording.bindings[set][0].last_level = last;
    return set;
}

/// Texture 2 has green in level 0 and blue in level 1, whose left half is then drawn red.
RecordedFrames levels_drawn() {
    RecordedFrames frames(width, height);
    frames.recording.surfaces.push_back({.name = "texture", .width = 8, .height = 8});
    frames.recording.surfaces[2].levels = {texels_of(green, 64), texels_of(blue, 16), {}};
    const std::uint32_t level = add_part(frames, {2, 1, 0}, 4);
    frames.draw(RecordedFrames::rectangle({-1, -1}, {0, 1}, red), Shade::colour, 0, level);
    return frames;
}

std::vector<RecordedFrames::Triangle> textured() {
    std::vector<RecordedFrames::Triangle> whole = RecordedFrames::everything(black);
    for (auto& triangle : whole)
        for (auto& corner : triangle) corner.colour = {(corner.position.x + 1) / 2, (corner.position.y + 1) / 2, 0, 1};
    return whole;
}

TEST(RecordingState, ALevelThatIsDrawnToIsWhatIsSampledOfIt) {
    for (const std::uint32_t base : {0U, 1U, 2U}) {
        RecordedFrames frames = levels_drawn();
        frames.draw(textured(), Shade::textured).bindings = bind_levels(frames, 2, base, base);
        const Drawn drawn(frames.recording);
        EXPECT_EQ(drawn.at(3, 3), base == 0 ? green : base == 1 ? red : glm::vec4(0)) << base;
        EXPECT_EQ(drawn.at(20, 3), base == 0 ? green : base == 1 ? blue : glm::vec4(0)) << base;
        EXPECT_EQ(run(drawn, "existing").colour, drawn.image.colour) << base;
    }
}

// As programs make smaller levels of larger ones.
TEST(RecordingState, ALevelIsDrawnToWhileAnotherIsSampled) {
    RecordedFrames frames = levels_drawn();
    frames.draw(textured(), Shade::textured, 0, add_part(frames, {2, 2, 0}, 2)).bindings = bind_levels(frames, 2, 1, 1);
    frames.draw(textured(), Shade::textured).bindings = bind_levels(frames, 2, 2, 2);
    const Drawn drawn(frames.recording);
    EXPECT_EQ(drawn.at(3, 3), red);
    EXPECT_EQ(drawn.at(20, 3), blue);
}

TEST(RecordingState, PlanesThatAreDrawnToAreClearedAndCopiedEachOnItsOwn) {
    for (const auto kind : {traces::SurfaceKind::layers, traces::SurfaceKind::cube, traces::SurfaceKind::volume}) {
        RecordedFrames frames(width, height);
        frames.recording.surfaces.push_back({.name = "planes", .kind = kind, .width = 4, .height = 4, .depth = 1});
        if (kind != traces::SurfaceKind::cube) frames.recording.surfaces[2].depth = 3;
        const std::size_t planes = kind == traces::SurfaceKind::cube ? 6 : 3;
        frames.recording.surfaces[2].levels = {texels_of(green, 16 * planes)};
        frames.clear(blue, add_part(frames, {2, 0, 0}, 4));
        frames.draw(RecordedFrames::everything(red), Shade::colour, 0, add_part(frames, {2, 0, 2}, 4));
        for (std::uint32_t plane = 0; plane < 3; ++plane) {
            traces::RecordedCopy copy;
            copy.name = "copy";
            copy.from = {2, 0, plane};
            copy.rectangle = {0, 0, 4, 4};
            copy.to_x = static_cast<std::int32_t>(4 * plane);
            frames.recording.frames[0].commands.emplace_back(copy);
        }
        const Drawn drawn(frames.recording);
        EXPECT_EQ(drawn.at(2, 2), blue);
        EXPECT_EQ(drawn.at(6, 2), green);
        EXPECT_EQ(drawn.at(10, 2), red);
    }
}

/// A window of black with a blit from a texture of these texels, which the test may change.
Drawn blitted(std::uint32_t texture_width, std::uint32_t texture_height, const std::vector<std::uint32_t>& codes,
              const std::function<void(traces::RecordedBlit&)>& change) {
    RecordedFrames frames(width, height);
    frames.add_texture(texture_width, texture_height, codes);
    frames.clear(black);
    traces::RecordedBlit blit;
    blit.name = "blit";
    blit.from = {2, 0, 0};
    blit.to = {0, 0, 0};
    blit.source = {0, 0, texture_width, texture_height};
    change(blit);
    frames.recording.frames[0].commands.emplace_back(blit);
    return Drawn(frames.recording);
}

constexpr std::uint32_t red_code = 0xFF0000FF, green_code = 0x00FF00FF, blue_code = 0x0000FFFF, white_code = 0xFFFFFFFF;

TEST(RecordingState, BlitsTakeTheNearestTexels) {
    for (const bool x : {false, true})
        for (const bool y : {false, true}) {
            const Drawn drawn =
                blitted(2, 2, {red_code, green_code, blue_code, white_code}, [&](traces::RecordedBlit& blit) {
                    blit.destination = {5, 3, 6, 4};
                    blit.mirrored_x = x;
                    blit.mirrored_y = y;
                });
            const std::array<glm::vec4, 4> texels{red, green, blue, glm::vec4(1)};
            for (std::uint32_t row = 0; row < 4; ++row)
                for (std::uint32_t column = 0; column < 6; ++column) {
                    const bool right = (column >= 3) != x, low = (row >= 2) != y;
                    EXPECT_EQ(drawn.at(5 + column, 3 + row), texels.at((low ? 2U : 0U) + (right ? 1U : 0U)));
                }
            for (const auto& [column, row] : {std::pair(4U, 3U), {11U, 3U}, {5U, 2U}, {5U, 7U}})
                EXPECT_EQ(drawn.at(column, row), black);
            EXPECT_EQ(run(drawn, "existing").colour, drawn.image.colour);
        }
}

// A pixel's centre comes to lie between two texels: it takes the one behind, as floor() does.
TEST(RecordingState, BlitsTakeTheTexelBehindABoundary) {
    for (const bool mirrored : {false, true}) {
        const Drawn drawn =
            blitted(4, 1, {red_code, green_code, blue_code, white_code}, [&](traces::RecordedBlit& blit) {
                blit.destination = {0, 0, 2, 1};
                blit.mirrored_x = mirrored;
            });
        EXPECT_EQ(drawn.at(mirrored ? 1 : 0, 0), green);
        EXPECT_EQ(drawn.at(mirrored ? 0 : 1, 0), glm::vec4(1));
    }
}

TEST(RecordingState, BlitsFilterAndClampAtTheEdges) {
    const Drawn drawn = blitted(2, 1, {red_code, blue_code}, [&](traces::RecordedBlit& blit) {
        blit.destination = {2, 1, 8, 1};
        blit.linear = true;
    });
    // Pixel i lies at (i + 0.5) / 4 texels; centres of texels are at 0.5 and 1.5.
    for (std::uint32_t i = 0; i < 8; ++i) {
        const float share = std::clamp((static_cast<float>(i) + 0.5F) / 4.0F - 0.5F, 0.0F, 1.0F);
        EXPECT_NEAR(drawn.at(2 + i, 1).b, share, 0.5F / 255 + 1e-6F) << i;
        EXPECT_NEAR(drawn.at(2 + i, 1).r, 1.0F - share, 0.5F / 255 + 1e-6F) << i;
    }
    EXPECT_EQ(run(drawn, "existing").colour, drawn.image.colour);
}

TEST(RecordingState, BlitsLeaveOutWhatLiesBeyondEitherSurface) {
    const Drawn drawn = blitted(2, 1, {red_code, green_code}, [&](traces::RecordedBlit& blit) {
        blit.source = {-1, 0, 4, 1};
        blit.destination = {21, 0, 4, 1}; // of columns 21 to 24 the last one is not there
    });
    EXPECT_EQ(drawn.at(21, 0), black);
    EXPECT_EQ(drawn.at(22, 0), red);
    EXPECT_EQ(drawn.at(23, 0), green);
}

TEST(RecordingState, BlitsAreCutByTheirScissor) {
    const Drawn drawn = blitted(1, 1, {red_code}, [&](traces::RecordedBlit& blit) {
        blit.destination = {0, 0, 10, 10};
        blit.scissor = PixelRectangle{2, 3, 4, 20};
    });
    EXPECT_EQ(drawn.at(2, 3), red);
    EXPECT_EQ(drawn.at(5, 9), red);
    for (const auto& [column, row] : {std::pair(1U, 3U), {6U, 3U}, {2U, 2U}, {2U, 10U}})
        EXPECT_EQ(drawn.at(column, row), black);
    const Drawn nothing = blitted(1, 1, {red_code}, [&](traces::RecordedBlit& blit) {
        blit.destination = {0, 0, 2, 2};
        blit.scissor = PixelRectangle{2, 0, 4, 4};
    });
    EXPECT_EQ(nothing.at(0, 0), black);
    EXPECT_EQ(nothing.at(2, 0), black);
}

TEST(RecordingState, BlitsScaleDepths) {
    RecordedFrames frames(width, height);
    frames.recording.surfaces.push_back(
        {.name = "other", .format = SurfaceFormat::d24s8, .width = width, .height = height});
    traces::TargetSet other;
    other.depth = traces::TargetSet::Target{2, 0, 0};
    other.width = width;
    other.height = height;
    frames.recording.targets.push_back(other);
    frames.clear(blue);
    frames.clear(black, 1).colours = 0;
    frames.draw(RecordedFrames::rectangle({-1, 0}, {0, 1}, black, 0.3F), Shade::colour,
                frames.add_state(depth_tested()), 1); // its upper left quarter
    traces::RecordedBlit blit;
    blit.name = "blit";
    blit.from = {2, 0, 0};
    blit.to = {1, 0, 0};
    blit.source = {0, 0, width / 2, height};
    blit.destination = {0, 0, width, height};
    frames.recording.frames[0].commands.emplace_back(blit);
    RasterState equal = depth_tested(false);
    equal.depth.compare = Compare::equal;
    frames.draw(RecordedFrames::everything(green, 0.3F), Shade::colour, frames.add_state(equal));
    const Drawn drawn(frames.recording);
    EXPECT_EQ(drawn.at(20, 4), green); // the upper half
    EXPECT_EQ(drawn.at(20, 12), blue);
}

/// Passes its inputs on, after so many additions of 0.
std::vector<std::uint32_t> vertex_shader(std::uint32_t additions) {
    SpirvAssembler a(SpirvAssembler::Stage::vertex);
    const Id v4 = a.vector(a.real(), 4);
    const Id place = a.input(v4, 0), colour = a.input(v4, 1), varying = a.output(v4, 0);
    a.name(place, "place");
    a.name(colour, "colour");
    a.name(varying, "shade");
    const Id zero = a.constant(0.0F), none = a.composite(v4, {zero, zero, zero, zero});
    Id position = a.load(place, v4);
    for (std::uint32_t i = 0; i < additions; ++i) position = a.result(SpirvAssembler::Op::f_add, v4, {position, none});
    a.store(a.built_in(SpirvAssembler::Storage::output, v4, 0), position);
    a.store(varying, a.load(colour, v4));
    return a.module();
}

struct VertexTime {
    std::uint64_t vertices = 0, unit_cycles = 0, cycles = 0;
};

/// Of many triangles beyond the window.
VertexTime vertex_time(std::uint32_t additions) {
    RecordedFrames frames(width, height);
    frames.recording.programs[0].vertex = vertex_shader(additions);
    std::vector<RecordedFrames::Triangle> triangles;
    for (int i = 0; i < 500; ++i) triangles.push_back(RecordedFrames::rectangle({2, 2}, {3, 3}, red)[0]);
    frames.draw(triangles);
    const Drawn drawn(frames.recording);
    const pipeline::RunResult result = run(drawn, "existing");
    const auto& shader = result.passes.at(0).counters->at("geometry")["vertex_shader"];
    return {shader["vertices"].get<std::uint64_t>(), shader["unit_cycles"].get<std::uint64_t>(), result.cycles};
}

// The default GPU takes four cycles for four instructions, in each of eight units.
TEST(RecordingState, VertexShadersTakeTheirInstructions) {
    constexpr std::uint32_t shorter = 60;
    const VertexTime plain = vertex_time(0), once = vertex_time(shorter);
    EXPECT_EQ(plain.vertices, 1500U);
    ASSERT_EQ(plain.unit_cycles % 1500, 0U);
    const std::uint64_t others = plain.unit_cycles / 1500; // loads, stores, the return
    EXPECT_EQ(once.unit_cycles, (others + shorter) * 1500);
    // Twice the instructions: twice the cycles of the units, and of the draw, which they bound.
    const VertexTime twice = vertex_time(static_cast<std::uint32_t>(2 * (others + shorter) - others));
    EXPECT_EQ(twice.unit_cycles, 2 * once.unit_cycles);
    EXPECT_NEAR(static_cast<double>(twice.cycles - once.cycles), static_cast<double>(once.unit_cycles) / 8, 70.0);
}

} // namespace recording_state_test
