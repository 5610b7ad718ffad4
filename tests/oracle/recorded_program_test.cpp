// What is recorded of a program that draws with OpenGL, beside what the program says:
// tests/programs/draws_with_opengl.cpp, on Mesa's llvmpipe, without a window system.
#include "sim/check.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program_run.hpp"
#include "traces/glsl.hpp"
#include "traces/recording/record_program.hpp"
#include "traces/recording/recording_check.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <gtest/gtest.h>

namespace recorded_program_test {

using pipeline::Semantic;
using traces::RecordedClear;
using traces::RecordedCopy;
using traces::RecordedDraw;
using traces::Recording;

class RecordedPrograms : public ::testing::Test {
  protected:
    void SetUp() override {
        program_ = ropsim_test::program().parent_path() / "draws_with_opengl";
        if (!std::filesystem::exists(program_))
            GTEST_SKIP() << "built without EGL (packages libegl-dev, libopengl-dev)";
        if (!traces::can_compile_glsl()) GTEST_SKIP() << "built without glslang (packages glslang-dev and spirv-tools)";
    }

    /// Nothing where the test is to be skipped.
    std::optional<Recording> record(const std::vector<std::string>& scenarios, std::uint32_t first = 0,
                                    bool isotropic = false) {
        traces::RecordRequest request;
        request.command = {program_.string()};
        request.command.insert(request.command.end(), scenarios.begin(), scenarios.end());
        request.first = first;
        request.end = static_cast<std::uint32_t>(scenarios.size());
        request.isotropic = isotropic;
        const std::atomic<bool> stop{false};
        try {
            Recording recording = traces::record_program(request, stop).recording;
            traces::check_recording(recording, "recording");
            EXPECT_EQ(traces::module_faults(recording, "recording"), std::vector<std::string>{});
            if (scenarios != std::vector<std::string>{"unrecorded"}) {
                EXPECT_EQ(recording.not_recorded, std::vector<traces::NotRecorded>{});
            }
            return recording;
        } catch (const sim::InputError& error) {
            if (std::string(error.what()).find("with status 77") == std::string::npos) throw;
            return std::nullopt;
        }
    }

    std::filesystem::path program_;
};

#define RECORD_OR_SKIP(name, ...)                                                                                      \
    const auto name##_ = record(__VA_ARGS__);                                                                          \
    if (!name##_) GTEST_SKIP() << "no surfaceless EGL with desktop OpenGL";                                            \
    const Recording& name = *name##_

} // namespace recorded_program_test

namespace traces {

void PrintTo(const NotRecorded& one, std::ostream* stream) { *stream << one.call << ", " << one.times << " times"; }

} // namespace traces

namespace recorded_program_test {

namespace {

template <class Command>
std::vector<Command> commands(const Recording& recording, std::size_t frame = 0) {
    std::vector<Command> result;
    for (const traces::RecordedCommand& command : recording.frames.at(frame).commands)
        if (const auto* one = std::get_if<Command>(&command)) result.push_back(*one);
    return result;
}

const pipeline::Geometry& geometry_of(const Recording& recording, const RecordedDraw& draw) {
    return recording.resources->geometries.at(draw.geometry);
}

/// Component c of vertex i, of floats.
float value_of(const Recording& recording, const pipeline::Geometry& geometry, Semantic semantic, std::uint32_t i,
               std::uint32_t c) {
    const pipeline::VertexAttribute* attribute = geometry.find(semantic);
    if (attribute == nullptr || attribute->type != pipeline::ComponentType::f32) return -1e30F;
    float value = 0.0F;
    std::memcpy(&value,
                recording.resources->buffers.at(attribute->buffer).bytes.data() + attribute->offset +
                    std::size_t{i} * attribute->stride + 4 * c,
                4);
    return value;
}

std::vector<std::uint32_t> indices_of(const Recording& recording, const pipeline::Geometry& geometry) {
    std::vector<std::uint32_t> result;
    const std::uint32_t size = pipeline::bytes_of(geometry.index_type);
    for (std::uint32_t i = 0; i < geometry.index_count; ++i) {
        std::uint32_t index = 0;
        std::memcpy(&index,
                    recording.resources->buffers.at(geometry.index_buffer).bytes.data() + geometry.index_offset +
                        std::size_t{i} * size,
                    size);
        result.push_back(index);
    }
    return result;
}

std::vector<float> floats(const std::vector<std::uint32_t>& words) {
    std::vector<float> result;
    for (const std::uint32_t word : words) result.push_back(std::bit_cast<float>(word));
    return result;
}

std::vector<std::uint32_t> value_named(const Recording& recording, std::uint32_t set, const std::string& name) {
    for (const traces::UniformValue& value : recording.values.at(set))
        if (value.name == name) return value.words;
    return {};
}

} // namespace

TEST_F(RecordedPrograms, ArraysAndUniformsAreThoseOfTheProgram) {
    RECORD_OR_SKIP(recording, {"arrays"});
    ASSERT_EQ(recording.frames.size(), 1U);
    const auto draws = commands<RecordedDraw>(recording);
    ASSERT_EQ(draws.size(), 1U);
    const pipeline::Geometry& geometry = geometry_of(recording, draws[0]);
    EXPECT_EQ(geometry.topology, pipeline::Topology::triangles);
    EXPECT_EQ(geometry.vertex_count, 3U);
    // The second vertex is the first that is drawn, and number 3 is the attribute's.
    const auto generic3 = static_cast<Semantic>(static_cast<unsigned>(Semantic::generic) + 3);
    EXPECT_EQ(value_of(recording, geometry, generic3, 0, 0), 0.5F);
    EXPECT_EQ(value_of(recording, geometry, generic3, 0, 1), -0.5F);
    EXPECT_EQ(geometry.find(generic3)->offset, 16U);
    const traces::RecordedProgram& program = recording.programs.at(draws[0].program);
    ASSERT_EQ(program.inputs.size(), 1U);
    EXPECT_EQ(program.inputs[0].variable, "place");
    EXPECT_EQ(program.inputs[0].first, static_cast<std::uint32_t>(generic3));
    EXPECT_EQ(floats(value_named(recording, draws[0].vertex_values, "turn")),
              (std::vector<float>{1.0F, 0.0F, 0.0F, -1.0F}));
    EXPECT_EQ(floats(value_named(recording, draws[0].fragment_values, "tints")),
              (std::vector<float>{1.0F, 2.0F, 3.0F, 4.0F, 0.5F, 0.25F, 0.125F, 1.0F}));
    EXPECT_EQ(value_named(recording, draws[0].fragment_values, "second"), (std::vector<std::uint32_t>{1}));
}

TEST_F(RecordedPrograms, IndicesHaveTheirBaseAddedAndTheLargestAsRestart) {
    RECORD_OR_SKIP(recording, {"elements"});
    const auto draws = commands<RecordedDraw>(recording);
    ASSERT_EQ(draws.size(), 3U);
    EXPECT_EQ(indices_of(recording, geometry_of(recording, draws[0])), (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(indices_of(recording, geometry_of(recording, draws[1])), (std::vector<std::uint32_t>{1, 2, 3}));
    EXPECT_EQ(draws[1].base_vertex, 1);
    const pipeline::Geometry& strips = geometry_of(recording, draws[2]);
    EXPECT_TRUE(strips.primitive_restart);
    EXPECT_EQ(indices_of(recording, strips), (std::vector<std::uint32_t>{0, 1, 2, 0xFFFF, 1, 2, 3}));
    EXPECT_EQ(strips.primitive_count(), 2U);
}

TEST_F(RecordedPrograms, VerticesOneByOneHaveTheValuesThatWereCurrent) {
    RECORD_OR_SKIP(recording, {"immediate"});
    const auto draws = commands<RecordedDraw>(recording);
    ASSERT_EQ(draws.size(), 1U);
    const pipeline::Geometry& geometry = geometry_of(recording, draws[0]);
    EXPECT_EQ(geometry.topology, pipeline::Topology::triangles);
    EXPECT_EQ(geometry.vertex_count, 4U);
    EXPECT_EQ(geometry.primitive_count(), 2U);
    EXPECT_EQ(value_of(recording, geometry, Semantic::position, 2, 0), 0.5F);
    EXPECT_EQ(value_of(recording, geometry, Semantic::colour, 1, 1), 0.25F);
    EXPECT_EQ(value_of(recording, geometry, Semantic::colour, 2, 2), 0.2F);
}

TEST_F(RecordedPrograms, ListsAreDrawsWithTheStateBetweenThem) {
    RECORD_OR_SKIP(recording, {"lists", "immediate"});
    const auto draws = commands<RecordedDraw>(recording);
    ASSERT_EQ(draws.size(), 2U);
    EXPECT_EQ(recording.states.at(draws[0].state).culling, pipeline::FaceCulling::none);
    EXPECT_EQ(recording.states.at(draws[1].state).culling, pipeline::FaceCulling::back);
    EXPECT_EQ(geometry_of(recording, draws[0]).vertex_count, 3U);
    EXPECT_EQ(value_of(recording, geometry_of(recording, draws[1]), Semantic::position, 2, 0), -0.5F);
    ASSERT_EQ(draws[0].constants.size(), 1U);
    EXPECT_EQ(draws[0].constants[0].variable, "colour");
    EXPECT_EQ(draws[0].constants[0].value, glm::vec4(1.0F, 0.0F, 0.0F, 1.0F));
    const auto after = commands<RecordedDraw>(recording, 1);
    EXPECT_EQ(recording.states.at(after.at(0).state).culling, pipeline::FaceCulling::none);
}

// What is kept of a list has names that glGenLists must not give to the program.
TEST_F(RecordedPrograms, ListsThatTheDriverNamedKeepTheirColours) {
    RECORD_OR_SKIP(recording, {"named_lists"});
    const auto draws = commands<RecordedDraw>(recording);
    ASSERT_EQ(draws.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        ASSERT_EQ(draws[i].constants.size(), 1U);
        EXPECT_EQ(draws[i].constants[0].value, i < 2 ? glm::vec4(1, 0, 0, 1) : glm::vec4(0, 1, 0, 1)) << i;
    }
}

TEST_F(RecordedPrograms, TexturesHaveTheirTexelsAndWhatShadersSeeOfThem) {
    RECORD_OR_SKIP(recording, {"texture"});
    const auto draws = commands<RecordedDraw>(recording);
    ASSERT_EQ(draws.size(), 1U);
    const auto& bindings = recording.bindings.at(draws[0].bindings);
    ASSERT_EQ(bindings.size(), 1U);
    EXPECT_EQ(bindings[0].variable, "texture0");
    const traces::RecordedSurface& surface = recording.surfaces.at(bindings[0].surface);
    EXPECT_EQ(surface.format, pipeline::SurfaceFormat::rg8);
    EXPECT_EQ(surface.levels.at(0), (std::vector{std::byte{10}, std::byte{20}, std::byte{30}, std::byte{40},
                                                 std::byte{50}, std::byte{60}, std::byte{70}, std::byte{80}}));
    using enum traces::Swizzle;
    EXPECT_EQ(bindings[0].swizzle, (std::array{red, red, red, green}));
    const traces::RecordedSampler& sampler = recording.samplers.at(bindings[0].sampler);
    EXPECT_EQ(sampler.min_filter, pipeline::Filter::nearest);
    EXPECT_EQ(sampler.wrap_u, pipeline::Wrap::clamp);
    EXPECT_EQ(sampler.wrap_v, pipeline::Wrap::repeat);
}

TEST_F(RecordedPrograms, WhatIsDrawnToIsWhatIsSampled) {
    RECORD_OR_SKIP(recording, {"targets"});
    const auto draws = commands<RecordedDraw>(recording);
    ASSERT_EQ(draws.size(), 3U);
    const auto copies = commands<RecordedCopy>(recording);
    ASSERT_EQ(copies.size(), 1U);
    const traces::TargetSet& into = recording.targets.at(draws[0].targets);
    EXPECT_EQ(into.width, 16U);
    EXPECT_EQ(into.height, 8U);
    EXPECT_FALSE(into.top_row_first);
    const std::uint32_t surface = into.colours.at(0)->surface;
    EXPECT_EQ(copies[0].to.surface, surface);
    EXPECT_EQ(copies[0].rectangle, (pipeline::PixelRectangle{5, 6, 4, 3}));
    EXPECT_EQ(copies[0].to_x, 2);
    EXPECT_EQ(copies[0].to_y, 1);
    EXPECT_EQ(recording.bindings.at(draws[2].bindings).at(0).surface, surface);
    // Copies turn no rows over, so the window lies as textures do.
    EXPECT_FALSE(recording.targets.at(recording.frames[0].shown).top_row_first);
}

TEST_F(RecordedPrograms, StatesAreThoseOfTheProgram) {
    RECORD_OR_SKIP(recording, {"states"});
    const auto draws = commands<RecordedDraw>(recording);
    ASSERT_EQ(draws.size(), 1U);
    const pipeline::RasterState& state = recording.states.at(draws[0].state);
    EXPECT_EQ(state.scissor, (pipeline::PixelRectangle{4, 48 - 8 - 12, 16, 12})); // row 0 is on top
    EXPECT_EQ(state.viewport, (pipeline::PixelRectangle{1, 48 - 2 - 20, 30, 20}));
    EXPECT_EQ(state.write_mask[0], 0b1101);
    EXPECT_TRUE(state.blend[0].enabled);
    EXPECT_EQ(state.blend[0].colour.source, pipeline::BlendFactor::source_alpha);
    EXPECT_EQ(state.blend[0].colour.target, pipeline::BlendFactor::one_minus_source_alpha);
    EXPECT_EQ(state.blend[0].alpha.source, pipeline::BlendFactor::zero);
    EXPECT_EQ(state.blend[0].alpha.target, pipeline::BlendFactor::one);
    EXPECT_TRUE(state.depth.test);
    EXPECT_FALSE(state.depth.write);
    EXPECT_EQ(state.depth.compare, pipeline::Compare::greater_equal);
    EXPECT_EQ(state.depth.bias_slope, -1.0F);
    EXPECT_EQ(state.depth.bias_constant, -2.0F);
    EXPECT_TRUE(state.stencil.test);
    EXPECT_EQ(state.stencil.back.compare, pipeline::Compare::less);
    EXPECT_EQ(state.stencil.back.reference, 5);
    EXPECT_EQ(state.stencil.back.compare_mask, 0x0F);
    EXPECT_EQ(state.stencil.front.stencil_fails, pipeline::StencilOperation::increment);
    EXPECT_EQ(state.stencil.front.depth_fails, pipeline::StencilOperation::zero);
    EXPECT_EQ(state.stencil.front.passes, pipeline::StencilOperation::replace);
    EXPECT_TRUE(state.front_is_clockwise);
    EXPECT_EQ(state.culling, pipeline::FaceCulling::front);
    const auto clears = commands<RecordedClear>(recording);
    ASSERT_EQ(clears.size(), 2U); // immediate() clears as well
    EXPECT_EQ(clears[0].write_mask[0], 0b1101);
    EXPECT_EQ(clears[0].colour, glm::vec4(0.25F, 0.5F, 0.75F, 1.0F));
    EXPECT_EQ(clears[0].scissor, state.scissor);
    EXPECT_TRUE(clears[0].depth.has_value());
    EXPECT_FALSE(clears[1].depth.has_value()); // depths are not written then
}

TEST_F(RecordedPrograms, FramesCountFromTheFirstSwap) {
    RECORD_OR_SKIP(recording, {"arrays", "elements", "immediate"}, 1);
    ASSERT_EQ(recording.frames.size(), 2U);
    EXPECT_EQ(recording.frames[0].number, 1U);
    EXPECT_EQ(commands<RecordedDraw>(recording, 0).size(), 3U);
    EXPECT_EQ(recording.frames[1].number, 2U);
    EXPECT_EQ(commands<RecordedDraw>(recording, 1).size(), 1U);
}

TEST_F(RecordedPrograms, WhatIsNotRecordedIsCounted) {
    RECORD_OR_SKIP(recording, {"unrecorded"});
    ASSERT_EQ(recording.not_recorded.size(), 1U);
    EXPECT_EQ(recording.not_recorded[0], (traces::NotRecorded{"glRectf", 2}));
}

TEST_F(RecordedPrograms, TheProgramIsNotDisturbed) {
    RECORD_OR_SKIP(recording, {"undisturbed"}); // ends with a status of its own where it is
    EXPECT_EQ(commands<RecordedDraw>(recording).size(), 2U);
}

TEST_F(RecordedPrograms, ProgramsWithoutFramesAreOneLine) {
    traces::RecordRequest request;
    const std::atomic<bool> stop{false};
    const auto line_of = [&](const std::vector<std::string>& command) -> std::string {
        request.command = command;
        try {
            traces::record_program(request, stop);
        } catch (const sim::InputError& error) {
            return error.what();
        }
        return {};
    };
    EXPECT_TRUE(line_of({"false"}).starts_with(
        "false: expected frame 0 to be drawn with OpenGL; the program ended with status 1 before"))
        << line_of({"false"});
    EXPECT_EQ(line_of({"no-such-program"}),
              "no-such-program: expected a program that can be run: No such file or directory");
    EXPECT_NE(line_of({"sh", "-c", "kill -9 $$"}).find("the program ended by signal 9 (Killed) before"),
              std::string::npos);
}

// What a user sees of it; without an X server, which the program needs none of.
TEST_F(RecordedPrograms, FramesThatDoNotComeAreSaid) {
    const ropsim_test::TemporaryFolder folder;
    ropsim_test::ProgramOptions options;
    options.environment = {"DISPLAY=:none"};
    const auto outcome =
        ropsim_test::run_program({"record", "--frames", "0:5", "--json", "-o", (folder.path() / "x.rtrace").string(),
                                  "--", program_.string(), "arrays", "elements"},
                                 options);
    if (outcome.error.find("with status 77") != std::string::npos) GTEST_SKIP() << outcome.error;
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    EXPECT_NE(outcome.error.find("frames 0:5 were asked for; the program ended with status 0 behind frame 1"),
              std::string::npos)
        << outcome.error;
}

// The program would run on without an end, and ropsim wait for it.
TEST_F(RecordedPrograms, NoRoomForWhatIsRecordedEndsTheProgram) {
    const ropsim_test::TemporaryFolder folder;
    ropsim_test::ProgramOptions options;
    options.environment = {"DISPLAY=:none"};
    options.file_limit = 1000;
    const auto outcome =
        ropsim_test::run_program({"record", "--frames", "0:1", "-o", (folder.path() / "x.rtrace").string(), "--",
                                  program_.string(), "arrays", "elements", "texture"},
                                 options);
    if (outcome.error.find("with status 77") != std::string::npos) GTEST_SKIP() << outcome.error;
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.error.find(": expected room for all that is recorded (TMPDIR names another folder)"),
              std::string::npos)
        << outcome.error;
    EXPECT_EQ(folder.files(), std::vector<std::string>());
}

TEST_F(RecordedPrograms, InterruptedOnesEndWithTheProgram) {
    traces::RecordRequest request;
    request.command = {"sleep", "60"};
    const std::atomic<bool> stop{true};
    EXPECT_THROW(traces::record_program(request, stop), sim::Interrupted);
}

} // namespace recorded_program_test
