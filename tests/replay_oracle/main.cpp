// replay_oracle: replays of recorded programs beside Mesa's own. tests/README.md says how to use it.
#include "sim/check.hpp"
#include "tests/replay_oracle/comparison.hpp"
#include "tests/replay_oracle/programs.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fmt/format.h>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace {

using namespace replay_oracle;

constexpr std::string_view usage =
    R"(Replays frames of programs that draw with OpenGL, lets Mesa replay the same, and compares.
  replay_oracle [OPTIONS] FILE...            apitrace files
  replay_oracle [OPTIONS] --debian [NAME...] programs of Debian, traced before: all that are installed, or these
  replay_oracle [OPTIONS] -- PROGRAM ARGS... any program
Options:
  --frames FIRST:END   frames to compare, counted from 0 (0:3; of Debian's programs those that it lists)
  --seconds N          after which a traced program is ended (240, of some programs of Debian less)
  --pictures N         pictures behind draws of a frame, evenly spaced, at most (40)
  --keep FOLDER        keeps traces, and pictures of both sides where they differ
Ends with 1 where a number is not as it has to be.
)";

struct Usage : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Arguments {
    ComparisonOptions comparison;
    bool frames_given = false, debian = false;
    std::optional<std::uint32_t> seconds;
    std::vector<std::string> names, command; ///< files or programs
};

std::uint32_t number_of(const std::string& text) {
    std::uint32_t number = 0;
    char behind = 0;
    if (std::sscanf(text.c_str(), "%u%c", &number, &behind) != 1)
        throw Usage(fmt::format("expected a number, got '{}'", text));
    return number;
}

Arguments arguments_of(const std::vector<std::string>& words) {
    Arguments result;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        const auto value = [&]() -> const std::string& {
            if (++i == words.size()) throw Usage(fmt::format("{}: expected a value", word));
            return words[i];
        };
        if (word == "--") {
            result.command.assign(words.begin() + static_cast<std::ptrdiff_t>(i) + 1, words.end());
            break;
        }
        if (word == "--debian") {
            result.debian = true;
        } else if (word == "--frames") {
            const std::string& frames = value();
            const std::size_t colon = std::min(frames.find(':'), frames.size());
            result.comparison.first = number_of(frames.substr(0, colon));
            result.comparison.end =
                colon == frames.size() ? result.comparison.first + 1 : number_of(frames.substr(colon + 1));
            result.frames_given = true;
        } else if (word == "--seconds") {
            result.seconds = number_of(value());
        } else if (word == "--pictures") {
            result.comparison.pictures_of_frame = number_of(value());
        } else if (word == "--keep") {
            result.comparison.folder_for_faults = value();
        } else if (word.starts_with("-")) {
            throw Usage(fmt::format("unknown option '{}'", word));
        } else {
            result.names.push_back(word);
        }
    }
    if (!result.debian && result.names.empty() && result.command.empty())
        throw Usage("expected an apitrace file, --debian, or -- and a program");
    return result;
}

std::vector<DebianProgram> programs_of(const Arguments& arguments) {
    std::vector<DebianProgram> programs;
    if (!arguments.command.empty())
        programs.push_back({std::filesystem::path(arguments.command.front()).filename().string(), "of the program",
                            arguments.command});
    const auto asked_for = [&](const DebianProgram& program) {
        return arguments.names.empty() || std::any_of(arguments.names.begin(), arguments.names.end(),
                                                      [&](const auto& name) { return program.name.starts_with(name); });
    };
    for (const DebianProgram& program : debian_programs()) {
        if (!arguments.debian || !asked_for(program)) continue;
        if (is_installed(program))
            programs.push_back(program);
        else
            std::fputs(fmt::format("{}: left out, not installed (package {})\n", program.name, program.package).c_str(),
                       stderr);
    }
    return programs;
}

/// What cannot be traced, played or drawn is a fault of its own.
Comparison compared(const std::string& name, const std::function<Comparison()>& work) {
    std::fputs(fmt::format("{} ...\n", name).c_str(), stderr);
    try {
        return work();
    } catch (const sim::InputError& error) {
        Comparison failed;
        failed.name = name;
        failed.faults.emplace_back(error.what());
        return failed;
    }
}

int run(const Arguments& arguments) {
    const SoftwareGraphics graphics;
    const TemporaryFolder temporary;
    const std::filesystem::path& keep = arguments.comparison.folder_for_faults;
    if (!keep.empty()) std::filesystem::create_directories(keep);
    std::vector<Comparison> done;
    if (!arguments.debian)
        for (const std::string& file : arguments.names) {
            const std::string name = std::filesystem::path(file).stem().string();
            done.push_back(compared(name, [&] { return compare(name, file, arguments.comparison); }));
        }
    for (DebianProgram program : programs_of(arguments)) {
        ComparisonOptions options = arguments.comparison;
        if (arguments.seconds) program.seconds = *arguments.seconds;
        if (!arguments.frames_given) {
            options.first = program.first;
            options.end = program.end;
        }
        const std::filesystem::path trace = (keep.empty() ? temporary.path() : keep) / (program.name + ".trace");
        done.push_back(compared(program.name, [&] {
            trace_program(program, trace);
            return compare(program.name, trace, options);
        }));
    }
    std::fputs(table_of(done).c_str(), stdout);
    for (const Comparison& one : done)
        for (const std::string& note : one.notes) std::fputs(fmt::format("{}: {}\n", one.name, note).c_str(), stdout);
    const std::vector<std::string> faults = faults_of(done);
    for (const std::string& fault : faults) std::fputs(fmt::format("NOT AS EXPECTED: {}\n", fault).c_str(), stdout);
    return faults.empty() ? 0 : 1;
}

} // namespace

int main(int count, char** words) {
    try {
        return run(arguments_of({words + 1, words + count}));
    } catch (const Usage& error) {
        std::fputs(fmt::format("replay_oracle: {}\n{}", error.what(), usage).c_str(), stderr);
        return 2;
    } catch (const std::exception& error) {
        std::fputs(fmt::format("replay_oracle: {}\n", error.what()).c_str(), stderr);
        return 1;
    }
}
