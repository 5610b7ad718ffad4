#include "traces/recording/import/programs.hpp"

#include "sim/check.hpp"
#include "traces/glsl.hpp"
#include "traces/recording/import/geometry.hpp"

#include <fmt/format.h>

namespace traces::recorded {

namespace {

/// Old attributes by their names; nothing for one that has none of them.
std::optional<std::uint32_t> old_slot(const std::string& name) {
    static const std::map<std::string, std::uint32_t> names{
        {"gl_Vertex", record_stream::slot_vertex}, {"gl_Normal", record_stream::slot_normal},
        {"gl_Color", record_stream::slot_colour},  {"gl_SecondaryColor", record_stream::slot_secondary},
        {"gl_FogCoord", record_stream::slot_fog},
    };
    constexpr const char* coordinates = "gl_MultiTexCoord";
    if (const auto found = names.find(name); found != names.end()) return found->second;
    if (!name.starts_with(coordinates)) return std::nullopt;
    return record_stream::slot_texcoord + static_cast<std::uint32_t>(name.back() - '0');
}

GlslProgram sources_of(const record_stream::Program& program) {
    GlslProgram sources;
    sources.name = program.name;
    for (const record_stream::Shader& shader : program.shaders)
        (shader.stage == GL_VERTEX_SHADER ? sources.vertex : sources.fragment).push_back(shader.source);
    for (const record_stream::Variable& output : program.outputs)
        if (output.location >= 0) sources.outputs[output.name] = static_cast<std::uint32_t>(output.location);
    return sources;
}

bool mentions(const record_stream::Program& program, const char* word) {
    for (const record_stream::Shader& shader : program.shaders)
        if (shader.source.find(word) != std::string::npos) return true;
    return false;
}

} // namespace

std::uint32_t fog_of_fixed_function() { return static_cast<std::uint32_t>(pipeline::Semantic::generic); }
std::uint32_t fog_of_programs() { return static_cast<std::uint32_t>(pipeline::Semantic::generic15); }

const ImportedProgram& ProgramImport::program_of(const record_stream::Program& program, std::int32_t number) {
    const auto [place, is_new] = known_.try_emplace(number);
    if (!is_new) return place->second;
    ImportedProgram& imported = place->second;
    CompiledProgram compiled;
    try {
        compiled = compile_glsl(sources_of(program));
    } catch (const sim::InputError& error) {
        imported.problem = error.what();
        return imported;
    }
    RecordedProgram& recorded = recording_.programs.emplace_back();
    recorded.name = program.name;
    recorded.vertex = std::move(compiled.vertex);
    recorded.fragment = std::move(compiled.fragment);
    for (const record_stream::Variable& attribute : program.attributes) {
        const auto slot =
            attribute.location >= 0
                ? std::optional(record_stream::slot_generic + static_cast<std::uint32_t>(attribute.location))
                : old_slot(attribute.name);
        if (!slot || *slot >= record_stream::slots) continue;
        recorded.inputs.push_back({attribute.name, semantic_of(*slot, fog_of_programs())});
        imported.variables[*slot] = attribute.name;
    }
    imported.number = static_cast<std::uint32_t>(recording_.programs.size() - 1);
    imported.flat = mentions(program, "flat");
    imported.numbers = mentions(program, "gl_VertexID");
    return imported;
}

std::uint32_t ProgramImport::number_of(const FixedFunctionProgram& program) {
    const auto [place, is_new] = fixed_function_.try_emplace({program.vertex, program.fragment}, 0);
    if (!is_new) return place->second;
    const std::string name = fmt::format("fixed function {}", fixed_function_.size() - 1);
    CompiledProgram compiled = compile_glsl({name, {program.vertex}, {program.fragment}, {}});
    recording_.programs.push_back({name, std::move(compiled.vertex), std::move(compiled.fragment), program.inputs});
    place->second = static_cast<std::uint32_t>(recording_.programs.size() - 1);
    return place->second;
}

} // namespace traces::recorded
