#include "traces/glsl.hpp"

#include "ropsim_build.hpp"
#include "sim/check.hpp"
#include "traces/child_process.hpp"
#include "traces/glsl_module/glsl_module.h"

#include <array>
#include <charconv>
#include <cstring>
#include <fmt/format.h>
#include <optional>
#include <span>

namespace traces {

namespace {

constexpr const char* module_file = "ropsim_glsl.so";
/// A module has a few words for each byte of its source, and some hundred that are always there.
constexpr std::size_t words_per_byte = 64, least_words = std::size_t{1} << 18U;

const RopsimGlslModule& glsl_module() {
    const auto* module = load_module<RopsimGlslModule>(module_file, ROPSIM_GLSL_MODULE_FUNCTION, "compiling GLSL",
                                                       "a build with glslang-dev and spirv-tools");
    if (module == nullptr || module->version != ROPSIM_GLSL_MODULE_VERSION)
        throw sim::InputError(fmt::format("compiling GLSL needs {} of this version of ropsim", module_file));
    return *module;
}

// Khronos SPIR-V specification 1.6, sections 2.3, 3.7, 3.20 and 3.52.
enum : std::uint32_t {
    op_name = 5,
    op_variable = 59,
    op_decorate = 71,
    storage_input = 1,
    storage_output = 3,
    decoration_location = 30,
    head_words = 5
};

/// Calls f(opcode, operands) for the instructions of a module; operands may be written.
template <class Words, class F>
void for_instructions(Words& words, F f) {
    for (std::size_t at = head_words; at < words.size();) {
        const std::size_t length = words[at] >> 16U;
        if (length == 0 || length > words.size() - at) return; // its reader will say so
        f(words[at] & 0xFFFFU, std::span(words).subspan(at + 1, length - 1));
        at += length;
    }
}

std::map<std::string, std::uint32_t> variables_by_name(const std::vector<std::uint32_t>& words, std::uint32_t storage) {
    std::map<std::uint32_t, std::string> names;
    std::map<std::string, std::uint32_t> result;
    for_instructions(words, [&](std::uint32_t op, std::span<const std::uint32_t> operands) {
        if (op == op_name && operands.size() >= 2) {
            const auto* text = reinterpret_cast<const char*>(&operands[1]);
            names[operands[0]] = std::string(text, ::strnlen(text, (operands.size() - 1) * 4));
        }
        if (op == op_variable && operands.size() >= 3 && operands[2] == storage)
            if (const auto name = names.find(operands[1]); name != names.end()) result[name->second] = operands[1];
    });
    return result;
}

std::map<std::uint32_t, std::uint32_t> locations_by_id(const std::vector<std::uint32_t>& words) {
    std::map<std::uint32_t, std::uint32_t> result;
    for_instructions(words, [&](std::uint32_t op, std::span<const std::uint32_t> operands) {
        if (op == op_decorate && operands.size() == 3 && operands[1] == decoration_location)
            result[operands[0]] = operands[2];
    });
    return result;
}

/// Moves variables that have a location; `wanted` is by name.
void relocate(std::vector<std::uint32_t>& words, std::uint32_t storage,
              const std::map<std::string, std::uint32_t>& wanted) {
    std::map<std::uint32_t, std::uint32_t> by_id;
    for (const auto& [name, id] : variables_by_name(words, storage))
        if (const auto location = wanted.find(name); location != wanted.end()) by_id[id] = location->second;
    for_instructions(words, [&](std::uint32_t op, std::span<std::uint32_t> operands) {
        if (op != op_decorate || operands.size() != 3 || operands[1] != decoration_location) return;
        if (const auto location = by_id.find(operands[0]); location != by_id.end()) operands[2] = location->second;
    });
}

/// glslang counts the locations of each stage for itself.
std::map<std::string, std::uint32_t> output_locations(const std::vector<std::uint32_t>& vertex) {
    const auto locations = locations_by_id(vertex);
    std::map<std::string, std::uint32_t> result;
    for (const auto& [name, id] : variables_by_name(vertex, storage_output))
        if (const auto location = locations.find(id); location != locations.end()) result[name] = location->second;
    return result;
}

} // namespace

GlslError::GlslError(const std::string& program, const std::string& failure)
    : InputError(fmt::format("{}: expected GLSL that glslang compiles: {}", program, failure)), problem(failure) {
    const std::string mark = ", line ";
    const std::size_t number = failure.find(mark);
    if (number == std::string::npos) return;
    const char* const end = failure.data() + failure.size();
    std::uint32_t value = 0;
    const auto [behind, status] = std::from_chars(failure.data() + number + mark.size(), end, value);
    if (status != std::errc() || behind == end || *behind != ':') return;
    line = value;
    problem = std::string(behind + 1, end);
    problem.erase(0, problem.find_first_not_of(' '));
    problem.erase(problem.find_last_not_of(' ') + 1);
}

CompiledProgram compile_glsl(const GlslProgram& program, GlslOptimisation optimisation) {
    const RopsimGlslModule& module = glsl_module();
    std::vector<RopsimGlslShader> shaders;
    std::size_t room = least_words;
    const auto add = [&](int stage, const std::vector<std::string>& sources) {
        for (const std::string& source : sources) {
            shaders.push_back({stage, source.c_str()});
            room += words_per_byte * source.size();
        }
    };
    add(ROPSIM_GLSL_VERTEX, program.vertex);
    add(ROPSIM_GLSL_FRAGMENT, program.fragment);
    using Sizes = std::array<std::size_t, ROPSIM_GLSL_STAGES>;
    const ChildResult result =
        in_child_process(sizeof(Sizes) + 4 * room, [&](std::span<unsigned char> out, std::span<char> line) {
            Sizes sizes{};
            auto* words = reinterpret_cast<std::uint32_t*>(out.data() + sizeof sizes);
            const int status =
                module.compile(shaders.data(), shaders.size(), optimisation == GlslOptimisation::performance, words,
                               room, sizes.data(), line.data(), line.size());
            std::memcpy(out.data(), sizes.data(), sizeof sizes);
            return status;
        });
    if (!result.failure.empty()) throw GlslError(program.name, result.failure);
    Sizes sizes{};
    std::memcpy(sizes.data(), result.bytes.data(), sizeof sizes);
    CHECK(sizes[0] <= room && sizes[1] <= room - sizes[0]);
    CompiledProgram compiled{std::vector<std::uint32_t>(sizes[0]), std::vector<std::uint32_t>(sizes[1])};
    const unsigned char* const words = result.bytes.data() + sizeof sizes;
    std::memcpy(compiled.vertex.data(), words, 4 * sizes[0]);
    std::memcpy(compiled.fragment.data(), words + 4 * sizes[0], 4 * sizes[1]);
    relocate(compiled.fragment, storage_input, output_locations(compiled.vertex));
    relocate(compiled.fragment, storage_output, program.outputs);
    return compiled;
}

bool can_compile_glsl() { return ropsim_build::find_module(module_file).has_value(); }

} // namespace traces
