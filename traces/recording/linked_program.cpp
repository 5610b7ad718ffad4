#include "traces/recording/linked_program.hpp"

#include "pipeline/vertex_program.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace traces {

namespace {

using spirv::InterfaceVariable;

void place_value(const spirv::UniformPlace& place, const UniformValue& value, std::vector<std::uint32_t>& words) {
    std::size_t next = 0;
    for (std::uint32_t element = 0; element < place.elements; ++element)
        for (std::uint32_t column = 0; column < place.columns; ++column)
            for (std::uint32_t component = 0; component < place.components; ++component) {
                if (next == value.words.size()) return;
                const std::uint32_t at = place.first + element * place.element_stride + column * place.column_stride +
                                         component * place.stride;
                std::uint32_t word = value.words[next++];
                if (place.kind == spirv::Kind::truth) word = word != 0 ? 1 : 0;
                if (at < words.size()) words[at] = word;
            }
}

/// The vertex shader's output for an input of the fragment shader: by name, for both are compiled together; else by
/// location.
const InterfaceVariable* output_for(const spirv::Program& vertex, const InterfaceVariable& input) {
    for (const InterfaceVariable& output : vertex.outputs)
        if (!output.decorations.built_in && !input.name.empty() && output.name == input.name) return &output;
    for (const InterfaceVariable& output : vertex.outputs)
        if (!output.decorations.built_in && output.decorations.location &&
            output.decorations.location == input.decorations.location)
            return &output;
    return nullptr;
}

std::unique_ptr<const ShaderStage> stage_of(const RecordedProgram& program, const std::vector<std::uint32_t>& words,
                                            const char* kind, std::uint32_t model) {
    if (words.empty()) return nullptr;
    std::unique_ptr<const ShaderStage> stage;
    try {
        stage = std::make_unique<const ShaderStage>(words);
    } catch (const sim::InputError& error) {
        throw sim::InputError(fmt::format("program \"{}\": {} shader: {}", program.name, kind, error.what()));
    }
    if (stage->program.entry.model != model)
        throw sim::InputError(fmt::format("program \"{}\": expected a {} shader, got one of execution model {}",
                                          program.name, kind, stage->program.entry.model));
    return stage;
}

} // namespace

std::vector<std::uint32_t> ShaderStage::uniform_words(const std::vector<UniformValue>& values) const {
    std::vector<std::uint32_t> words(program.uniform_words);
    for (const UniformValue& value : values) {
        const auto block =
            std::find_if(program.uniforms.begin(), program.uniforms.end(),
                         [&value](const spirv::UniformVariable& one) { return one.block && one.name == value.name; });
        if (block != program.uniforms.end()) {
            const std::size_t count = std::min<std::size_t>(block->words, value.words.size());
            std::copy_n(value.words.begin(), count, words.begin() + block->first);
        } else if (const auto place = program.uniform(module, value.name)) {
            place_value(*place, value, words);
        }
    }
    return words;
}

LinkedProgram::LinkedProgram(const RecordedProgram& program)
    : name(program.name),
      vertex(stage_of(program, program.vertex, "vertex", 0)),
      fragment(stage_of(program, program.fragment, "fragment", 4)) {
    if (!vertex || vertex->program.built_in(built_in::position) == nullptr)
        throw sim::InputError(
            fmt::format("program \"{}\": expected a vertex shader that writes the position", program.name));
    if (!fragment) return;
    for (const InterfaceVariable& input : fragment->program.inputs) {
        if (input.decorations.built_in) continue;
        const InterfaceVariable* output = output_for(vertex->program, input);
        if (output == nullptr)
            notes.push_back(fmt::format("program {}: nobody writes the varying {}: it is 0", name, input.name));
        const bool alike =
            output == nullptr || (output->components == input.components && output->columns == input.columns &&
                                  output->elements == input.elements);
        if (!alike)
            throw sim::InputError(
                fmt::format("program \"{}\": varying {}: expected one type in both shaders", name, input.name));
        for (std::uint32_t i = 0; i < input.columns * input.elements; ++i)
            varyings.push_back({&input, output, i * input.components, input.components});
        if (varyings.size() > pipeline::most_varyings)
            throw sim::InputError(
                fmt::format("program \"{}\": expected at most {} varying vectors", name, pipeline::most_varyings));
    }
}

} // namespace traces
