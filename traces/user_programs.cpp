#include "traces/user_programs.hpp"

#include "models/programs/language/user_program.hpp"
#include "models/programs/program_file.hpp"
#include "ropsim_build.hpp"
#include "sim/check.hpp"
#include "traces/glsl.hpp"
#include "traces/shader_programs/program.hpp"

#include <charconv>
#include <filesystem>
#include <fmt/format.h>

namespace traces {

namespace {

using shader_programs::TaskModules;

// The last line of a program in GLSL that needs its file no more: a comment, then the words of each module.
constexpr std::string_view modules_mark = "// SPIR-V";
constexpr std::size_t digits_of_word = 8, most_words_of_module = 1U << 20;

bool is_glsl(std::string_view program) { return models::program_name(program).ends_with(".glsl"); }

std::vector<std::uint32_t> compile_user_glsl(const std::string& source, const std::string& name) {
    try {
        return compile_glsl({name, {}, {source}, {}}).fragment;
    } catch (const GlslError& error) {
        if (error.line == 0) throw;
        throw sim::InputError(
            fmt::format("{}:{}: expected GLSL that glslang compiles: {}", name, error.line, error.problem));
    } catch (const sim::InputError& error) {
        throw sim::InputError(fmt::format("{}: {}", name, error.what()));
    }
}

std::string line_of_modules(const TaskModules& modules) {
    std::string line(modules_mark);
    for (const std::vector<std::uint32_t>& words : modules) {
        if (words.empty()) continue;
        line += ' ';
        for (const std::uint32_t word : words) line += fmt::format("{:08x}", word);
    }
    return line;
}

/// Where that line begins, behind the text and a line feed.
std::size_t place_of_modules(std::string_view program) {
    const std::size_t line = program.rfind('\n') + 1;
    if (!program.substr(line).starts_with(modules_mark) || line == models::program_name(program).size() + 1)
        throw sim::InputError(fmt::format("{}: expected the program's text and a last line '{} ...' with its modules",
                                          models::program_name(program), modules_mark));
    return line;
}

std::vector<std::uint32_t> module_of_digits(std::string_view text, std::string_view name) {
    std::vector<std::uint32_t> words(text.size() / digits_of_word);
    bool good = !text.empty() && text.size() % digits_of_word == 0 && words.size() <= most_words_of_module;
    for (std::size_t i = 0; good && i < words.size(); ++i) {
        const char* const first = text.data() + i * digits_of_word;
        const auto [behind, status] = std::from_chars(first, first + digits_of_word, words[i], 16);
        good = status == std::errc() && behind == first + digits_of_word;
    }
    if (!good)
        throw sim::InputError(fmt::format("{}: expected modules of 1 to {} words, {} hexadecimal digits each", name,
                                          most_words_of_module, digits_of_word));
    return words;
}

TaskModules modules_of_line(std::string_view line, const shader_programs::Declaration& declaration) {
    TaskModules modules;
    const std::size_t expected = modules.size() - (declaration.drains() ? 0 : 1);
    line.remove_prefix(modules_mark.size());
    std::size_t count = 0;
    for (; line.starts_with(' ') && count < expected; ++count) {
        line.remove_prefix(1);
        const std::string_view module = line.substr(0, line.find(' '));
        modules[count] = module_of_digits(module, declaration.name);
        line.remove_prefix(module.size());
    }
    if (count != expected || !line.empty())
        throw sim::InputError(
            fmt::format("{}: expected {} modules behind the program's text", declaration.name, expected));
    return modules;
}

} // namespace

bool is_user_program(std::string_view program) { return is_glsl(program) || models::is_user_program(program); }

bool is_program_file(std::string_view program) {
    return is_user_program(program) && models::program_name(program).size() == program.size();
}

shader_programs::Declaration glsl_declaration(std::string_view program) {
    const std::string_view text = is_program_file(program) ? program : program.substr(0, place_of_modules(program) - 1);
    return shader_programs::declaration_of(std::string(models::program_name(program)), models::program_text(text));
}

models::ProgramChoice chosen_program(std::string_view program, const models::ProgramOptions& options) {
    if (!is_glsl(program)) return models::choose_program(program, options);
    models::refuse_entry_kind(program, options.entry);
    const shader_programs::Declaration declaration = glsl_declaration(program);
    const TaskModules modules =
        is_program_file(program)
            ? shader_programs::compile_tasks(declaration, options.k, options.opacity, compile_user_glsl)
            : modules_of_line(program.substr(place_of_modules(program)), declaration);
    return shader_programs::program_of(declaration, options.k, modules);
}

std::uint32_t usual_entries(std::string_view program) {
    return is_glsl(program) ? glsl_declaration(program).default_k : models::load_user_program(program, 0).program->k();
}

std::string self_contained(const std::string& program, std::uint32_t k, float opacity) {
    if (!is_program_file(program)) return program;
    const std::string name = std::filesystem::path(program).filename().string();
    if (!is_glsl(program)) return name + "\n" + models::program_text(program);
    const shader_programs::Declaration declaration = glsl_declaration(program);
    const TaskModules modules = shader_programs::compile_tasks(declaration, k, opacity, compile_user_glsl);
    return name + "\n" + declaration.text + "\n" + line_of_modules(modules);
}

std::vector<std::string> shipped_glsl_programs() { return ropsim_build::data_files("models/programs", ".glsl"); }

} // namespace traces
