// Shaders in place of fixed functions: what decides their texts, and what goes into uniforms.
#include "sim/check.hpp"
#include "traces/recording/fixed_function.hpp"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <sstream>

namespace fixed_function_texts {

namespace {

using namespace traces;

/// Lit by one light at a place, two textures, fog.
FixedFunctionState ordinary() {
    FixedFunctionState state;
    state.lighting.enabled = true;
    state.lighting.lights[0].enabled = true;
    state.lighting.lights[0].position = {1.0F, 2.0F, 3.0F, 1.0F};
    state.units[0].target = state.units[2].target = UnitTarget::two_dimensional;
    state.units[2].format = BaseFormat::rgb;
    state.fog.mode = FogMode::linear;
    return state;
}

std::vector<float> floats_of(const std::vector<UniformValue>& values, const std::string& name) {
    std::vector<float> result;
    for (const UniformValue& value : values)
        if (value.name == name)
            for (const std::uint32_t word : value.words) result.push_back(std::bit_cast<float>(word));
    return result;
}

bool has_input(const FixedFunctionProgram& program, const std::string& name) {
    return std::ranges::any_of(program.inputs, [&](const ShaderInputSource& input) { return input.variable == name; });
}

/// Words of each uniform that a text declares; samplers have none.
std::map<std::string, std::size_t> declared_uniforms(const std::string& text) {
    const std::map<std::string, std::size_t> words{{"float", 1}, {"vec3", 3}, {"vec4", 4}, {"mat3", 9}, {"mat4", 16}};
    std::map<std::string, std::size_t> result;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream parts(line);
        std::string first, type, name;
        parts >> first >> type >> name;
        if (first == "uniform" && words.contains(type)) result[name.substr(0, name.size() - 1)] = words.at(type);
    }
    return result;
}

std::map<std::string, std::size_t> given_uniforms(const std::vector<UniformValue>& values) {
    std::map<std::string, std::size_t> result;
    for (const UniformValue& value : values) result[value.name] = value.words.size();
    EXPECT_EQ(result.size(), values.size());
    return result;
}

TEST(FixedFunctionTexts, AreTheSameWhateverTheValues) {
    FixedFunctionState state = ordinary();
    const FixedFunctionProgram before = fixed_function_program(state);
    state.model_view[0] = {0.0F, 2.0F, 0.0F, 0.0F};
    state.projection[1][1] = 3.0F;
    state.rescale_normal = true;
    state.lighting.ambient = glm::vec4(0.9F);
    state.lighting.materials[0] = {glm::vec4(0.1F), glm::vec4(0.2F), glm::vec4(0.3F), glm::vec4(0.4F), 50.0F};
    FixedLight& light = state.lighting.lights[0];
    light.ambient = light.diffuse = light.specular = glm::vec4(0.5F);
    light.position = {-3.0F, 0.0F, 0.0F, 2.0F};
    state.units[0].constant = glm::vec4(0.7F);
    state.fog.colour = glm::vec4(0.4F);
    state.fog.start = 3.0F;
    state.fog.end = 8.0F;
    state.points.size = 9.0F; // no points are drawn
    const FixedFunctionProgram after = fixed_function_program(state);
    EXPECT_EQ(before.vertex, after.vertex);
    EXPECT_EQ(before.fragment, after.fragment);
    EXPECT_NE(before.vertex_values, after.vertex_values);
    EXPECT_NE(before.fragment_values, after.fragment_values);
}

TEST(FixedFunctionTexts, DoNotDependOnWhichLightsShine) {
    FixedFunctionState one = ordinary(), other = ordinary();
    other.lighting.lights[5] = other.lighting.lights[0];
    other.lighting.lights[0].enabled = false;
    EXPECT_EQ(fixed_function_program(one).vertex, fixed_function_program(other).vertex);
    EXPECT_EQ(fixed_function_program(one).vertex_values, fixed_function_program(other).vertex_values);
}

struct Feature {
    const char* name;
    bool vertex, fragment; ///< whether the text changes
    std::function<void(FixedFunctionState&)> ask;
};

TEST(FixedFunctionTexts, ChangeOnlyWhereAFeatureIs) {
    const std::vector<Feature> features{
        {"clip plane", true, false, [](auto& s) { s.clip_planes = 4; }},
        {"normalize", true, false, [](auto& s) { s.normalize = true; }},
        {"no lighting", true, false, [](auto& s) { s.lighting.enabled = false; }},
        {"second light", true, false, [](auto& s) { s.lighting.lights[3].enabled = true; }},
        {"directional", true, false, [](auto& s) { s.lighting.lights[0].position.w = 0.0F; }},
        {"attenuation", true, false, [](auto& s) { s.lighting.lights[0].attenuation.y = 0.1F; }},
        {"cone", true, false, [](auto& s) { s.lighting.lights[0].spot_cutoff = 30.0F; }},
        {"local viewer", true, false, [](auto& s) { s.lighting.local_viewer = true; }},
        {"two sides", true, true, [](auto& s) { s.lighting.two_sided = true; }},
        {"separate specular", true, true, [](auto& s) { s.lighting.separate_specular = true; }},
        {"colour material", true, false,
         [](auto& s) { s.lighting.colour_material[0] = ColourMaterial::ambient_and_diffuse; }},
        {"colour material of the back", false, false,
         [](auto& s) { s.lighting.colour_material[1] = ColourMaterial::diffuse; }},
        {"colour sum while lit", false, false, [](auto& s) { s.colour_sum = true; }},
        {"flat", true, true, [](auto& s) { s.flat = true; }},
        {"colours of vertices not clamped", true, true, [](auto& s) { s.clamp_vertex_colours = false; }},
        {"third texture", true, true, [](auto& s) { s.units[1].target = UnitTarget::cube; }},
        {"cube", false, true, [](auto& s) { s.units[0].target = UnitTarget::cube; }},
        {"comparison", false, true, [](auto& s) { s.units[0].compares = true; }},
        {"format", false, true, [](auto& s) { s.units[0].format = BaseFormat::alpha; }},
        {"equivalent format", false, false, [](auto& s) { s.units[0].format = BaseFormat::intensity; }},
        {"environment", false, true, [](auto& s) { s.units[0].environment = TextureEnvironment::add; }},
        {"combine what modulate does", false, false,
         [](auto& s) { s.units[0].environment = TextureEnvironment::combine; }},
        {"scale without combine", false, false, [](auto& s) { s.units[0].colour.scale = 4; }},
        {"generation", true, false, [](auto& s) { s.units[0].generation[0] = CoordinateGeneration::sphere_map; }},
        {"texture matrix", true, false, [](auto& s) { s.units[0].matrix[3][0] = 0.5F; }},
        {"sprites without points", false, false,
         [](auto& s) { s.points.sprites = s.units[0].replaced_in_sprites = true; }},
        {"fog mode", false, true, [](auto& s) { s.fog.mode = FogMode::exponential; }},
        {"fog coordinate", true, false, [](auto& s) { s.fog.from_vertex = true; }},
        {"points", false, false, [](auto& s) { s.points.drawn = true; }},
        {"attenuated points", true, false, [](auto& s) { s.points.drawn = true, s.points.attenuation.z = 0.1F; }},
        {"fading points", true, true, [](auto& s) { s.points.drawn = s.points.fades = true; }},
        {"sprites", true, true,
         [](auto& s) { s.points.drawn = s.points.sprites = s.units[0].replaced_in_sprites = true; }},
        {"alpha test", false, true, [](auto& s) { s.alpha_test = pipeline::Compare::greater; }},
    };
    const FixedFunctionProgram plain = fixed_function_program(ordinary());
    for (const Feature& feature : features) {
        FixedFunctionState state = ordinary();
        feature.ask(state);
        const FixedFunctionProgram program = fixed_function_program(state);
        EXPECT_EQ(program.vertex != plain.vertex, feature.vertex) << feature.name << "\n" << program.vertex;
        EXPECT_EQ(program.fragment != plain.fragment, feature.fragment) << feature.name << "\n" << program.fragment;
        // Values are those of the uniforms that are declared, neither more nor fewer.
        EXPECT_EQ(declared_uniforms(program.vertex), given_uniforms(program.vertex_values)) << feature.name;
        EXPECT_EQ(declared_uniforms(program.fragment), given_uniforms(program.fragment_values)) << feature.name;
    }
}

TEST(FixedFunctionTexts, LeaveOutWhatALaterUnitReplaces) {
    FixedFunctionState state = ordinary();
    state.units[2].format = BaseFormat::rgba;
    state.units[2].environment = TextureEnvironment::replace;
    const FixedFunctionProgram program = fixed_function_program(state);
    EXPECT_EQ(program.units, std::vector<std::uint32_t>{2});
    EXPECT_FALSE(has_input(program, "normal"));
    EXPECT_FALSE(has_input(program, "texcoord0"));
    state.units[2].format = BaseFormat::rgb; // keeps the alpha before
    EXPECT_EQ(fixed_function_program(state).units, (std::vector<std::uint32_t>{0, 2}));
    EXPECT_TRUE(has_input(fixed_function_program(state), "normal"));
}

TEST(FixedFunctionTexts, SampleTheTexturesThatCombinersName) {
    FixedFunctionState state = ordinary();
    state.units[0].target = UnitTarget::none;
    state.units[2].environment = TextureEnvironment::combine;
    state.units[2].colour.arguments[0] = {CombineSource::texture_of_unit, CombineOperand::colour, 5};
    state.units[2].alpha.arguments[0] = {CombineSource::constant, CombineOperand::alpha};
    EXPECT_TRUE(fixed_function_program(state).units.empty()); // unit 5 is off
    state.units[5].target = UnitTarget::rectangle;
    EXPECT_EQ(fixed_function_program(state).units, std::vector<std::uint32_t>{5});
}

TEST(FixedFunctionTexts, NameInputsByWhatFeedsThem) {
    FixedFunctionState state = ordinary();
    state.fog.from_vertex = true;
    state.lighting.colour_material[0] = ColourMaterial::diffuse;
    std::map<std::string, pipeline::Semantic> inputs;
    for (const ShaderInputSource& input : fixed_function_program(state).inputs)
        inputs[input.variable] = static_cast<pipeline::Semantic>(input.first);
    using pipeline::Semantic;
    EXPECT_EQ(inputs, (std::map<std::string, Semantic>{{"position", Semantic::position},
                                                       {"normal", Semantic::normal},
                                                       {"colour", Semantic::colour},
                                                       {"texcoord0", Semantic::texcoord0},
                                                       {"texcoord2", Semantic::texcoord2},
                                                       {"fog_coordinate", Semantic::generic}}));
    state.lighting.enabled = false;
    state.colour_sum = true;
    state.fog.mode = FogMode::none;
    EXPECT_TRUE(has_input(fixed_function_program(state), "secondary_colour"));
    EXPECT_FALSE(has_input(fixed_function_program(state), "normal"));
}

TEST(FixedFunctionValues, AreWhatShadersDoNotComputeForEachVertex) {
    FixedFunctionState state = ordinary();
    state.model_view = glm::mat4(2.0F);
    state.model_view[3] = {1.0F, 2.0F, 3.0F, 1.0F};
    state.lighting.ambient = glm::vec4(0.5F);
    FixedLight& light = state.lighting.lights[0];
    light.diffuse = {1.0F, 0.5F, 0.25F, 1.0F};
    light.position = {2.0F, 4.0F, 6.0F, 2.0F};
    state.lighting.materials[0].diffuse = {0.5F, 0.5F, 0.5F, 0.25F};
    state.lighting.materials[0].ambient = glm::vec4(0.5F);
    state.lighting.materials[0].emission = {0.125F, 0.0F, 0.0F, 0.0F};
    const auto values = [&] { return fixed_function_program(state).vertex_values; };
    EXPECT_EQ(floats_of(values(), "front_light0_diffuse"), (std::vector<float>{0.5F, 0.25F, 0.125F}));
    EXPECT_EQ(floats_of(values(), "front_scene"), (std::vector<float>{0.375F, 0.25F, 0.25F}));
    EXPECT_EQ(floats_of(values(), "front_alpha"), std::vector<float>{0.25F});
    EXPECT_EQ(floats_of(values(), "light0_position"), (std::vector<float>{1.0F, 2.0F, 3.0F}));
    EXPECT_EQ(floats_of(values(), "model_view_projection")[12], 1.0F);
    // Inverse and transposed; rescaled it has the length that normals had.
    EXPECT_EQ(floats_of(values(), "normal_matrix")[0], 0.5F);
    state.rescale_normal = true;
    EXPECT_EQ(floats_of(values(), "normal_matrix")[0], 1.0F);
    state.model_view[0] = glm::vec4(0.0F); // a matrix without inverse
    EXPECT_EQ(floats_of(values(), "normal_matrix")[0], 1.0F);
}

TEST(FixedFunctionValues, OfFogAndAlphaAreClamped) {
    FixedFunctionState state = ordinary();
    state.fog.colour = {2.0F, -1.0F, 0.5F, 1.0F};
    state.fog.start = state.fog.end = 3.0F;
    state.alpha_test = pipeline::Compare::less;
    state.alpha_reference = 1.5F;
    const FixedFunctionProgram program = fixed_function_program(state);
    EXPECT_EQ(floats_of(program.fragment_values, "fog_colour"), (std::vector<float>{1.0F, 0.0F, 0.5F}));
    EXPECT_EQ(floats_of(program.fragment_values, "fog_scale"), std::vector<float>{1.0F});
    EXPECT_EQ(floats_of(program.fragment_values, "alpha_reference"), std::vector<float>{255.0F});
    state.alpha_steps = 0.0F; // a float target
    EXPECT_EQ(floats_of(fixed_function_program(state).fragment_values, "alpha_reference"), std::vector<float>{1.0F});
}

TEST(FixedFunctionPoints, HaveASizeOfTheirOwnOnlyWhenItDiffersFromPointToPoint) {
    FixedFunctionState state = ordinary();
    state.points.attenuation = {0.0F, 0.0F, 1.0F};
    EXPECT_FALSE(fixed_function_program(state).sizes_points); // triangles
    state.points.drawn = true;
    EXPECT_TRUE(fixed_function_program(state).sizes_points);
    state.points.attenuation = {1.0F, 0.0F, 0.0F};
    EXPECT_FALSE(fixed_function_program(state).sizes_points);
}

void expect_refused(const std::function<void(FixedTextureUnit&)>& change, const std::string& message) {
    FixedFunctionState state = ordinary();
    state.units[2].environment = TextureEnvironment::combine;
    change(state.units[2]);
    try {
        fixed_function_program(state);
        FAIL() << "expected: " << message;
    } catch (const sim::InputError& error) {
        EXPECT_EQ(std::string(error.what()), "texture unit 2 without shaders: " + message);
    }
}

TEST(FixedFunctionErrors, NameTheUnitAndWhatIsPossible) {
    expect_refused([](auto& unit) { unit.generation[2] = CoordinateGeneration::sphere_map; },
                   "a sphere map gives coordinates s and t, not r");
    expect_refused([](auto& unit) { unit.generation[3] = CoordinateGeneration::normal_map; },
                   "maps of reflections and normals give coordinates s, t and r, not q");
    expect_refused([](auto& unit) { unit.alpha.function = CombineFunction::dot3_rgb; },
                   "dot products combine colours, not alpha");
    expect_refused([](auto& unit) { unit.colour.scale = 3; }, "the scale of a combiner is 1, 2 or 4, not 3");
    expect_refused(
        [](auto& unit) {
            unit.alpha.arguments[1] = {CombineSource::texture_of_unit, {}, 8};
        },
        "a combiner reads the texture of unit 0 to 7, not 8");
}

} // namespace

} // namespace fixed_function_texts
