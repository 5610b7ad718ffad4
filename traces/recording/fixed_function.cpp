#include "traces/recording/fixed_function.hpp"

#include "sim/check.hpp"
#include "traces/recording/fixed_function/fragment_text.hpp"
#include "traces/recording/fixed_function/vertex_text.hpp"

#include <fmt/format.h>

namespace traces {

namespace {

/// What OpenGL refuses when it is set.
void check_unit(const FixedTextureUnit& unit, std::uint32_t number) {
    const auto refuse = [&](const std::string& what) {
        throw sim::InputError(fmt::format("texture unit {} without shaders: {}", number, what));
    };
    for (std::uint32_t i = 2; i < 4; ++i) {
        const char name = i == 2 ? 'r' : 'q';
        const CoordinateGeneration generation = unit.generation[i];
        if (generation == CoordinateGeneration::sphere_map)
            refuse(fmt::format("a sphere map gives coordinates s and t, not {}", name));
        if (i == 3 &&
            (generation == CoordinateGeneration::reflection_map || generation == CoordinateGeneration::normal_map))
            refuse("maps of reflections and normals give coordinates s, t and r, not q");
    }
    if (unit.environment != TextureEnvironment::combine) return;
    if (unit.alpha.function >= CombineFunction::dot3_rgb) refuse("dot products combine colours, not alpha");
    for (const Combiner* combiner : {&unit.colour, &unit.alpha}) {
        if (combiner->scale != 1 && combiner->scale != 2 && combiner->scale != 4)
            refuse(fmt::format("the scale of a combiner is 1, 2 or 4, not {}", combiner->scale));
        for (const CombineArgument& argument : combiner->arguments)
            if (argument.source == CombineSource::texture_of_unit && argument.unit >= fixed_function_units)
                refuse(fmt::format("a combiner reads the texture of unit 0 to {}, not {}", fixed_function_units - 1,
                                   argument.unit));
    }
}

std::uint32_t semantic_of(const std::string& input) {
    using pipeline::Semantic;
    Semantic semantic = Semantic::generic;
    if (input == "position")
        semantic = Semantic::position;
    else if (input == "normal")
        semantic = Semantic::normal;
    else if (input == "colour")
        semantic = Semantic::colour;
    else if (input == "secondary_colour")
        semantic = Semantic::secondary_colour;
    else if (input.starts_with("texcoord"))
        semantic = pipeline::texcoord(static_cast<std::uint32_t>(input.back() - '0'));
    return static_cast<std::uint32_t>(semantic);
}

} // namespace

FixedFunctionProgram fixed_function_program(const FixedFunctionState& state) {
    for (std::uint32_t i = 0; i < fixed_function_units; ++i)
        if (state.units[i].target != UnitTarget::none) check_unit(state.units[i], i);
    const fixed_function::FragmentText fragment = fixed_function::fragment_text(state);
    const fixed_function::ShaderText vertex = fixed_function::vertex_text(state, fragment.text);
    FixedFunctionProgram program;
    program.vertex = vertex.source();
    program.fragment = fragment.text.source();
    for (const std::string& input : vertex.inputs()) program.inputs.push_back({input, semantic_of(input)});
    program.vertex_values = vertex.values();
    program.fragment_values = fragment.text.values();
    program.units = fragment.units;
    program.sizes_points = fixed_function::sizes_points(state);
    return program;
}

} // namespace traces
