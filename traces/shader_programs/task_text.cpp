#include "traces/shader_programs/task_text.hpp"

#include <fmt/format.h>
#include <limits>

namespace traces::shader_programs {

namespace {

/// Names to components of an array of vec4, one float after the other.
std::string component(const char* array, std::size_t place) {
    return fmt::format("{}[{}].{}", array, place / 4, "xyzw"[place % 4]);
}

std::string assignments(const std::string& object, const Fields& fields, const char* array, std::size_t first) {
    std::string text;
    for (std::size_t i = 0; i < fields.size(); ++i)
        text += fmt::format("    {}.{} = {};\n", object, fields[i], component(array, first + i));
    return text;
}

class TaskWriter {
  public:
    TaskWriter(const Declaration& program, std::uint32_t k) : program_(program), k_(k) {}

    std::string main(Task task) const {
        if (task == Task::entry) return entry();
        std::string text = declarations(task != Task::clear, task == Task::modify);
        text += "void main() {\n    Entry kbuffer_e[k];\n";
        if (has_state()) text += "    State kbuffer_s;\n";
        text += task == Task::clear ? cleared() : fetched();
        const std::string state = has_state() ? ", kbuffer_s" : "";
        if (task == Task::modify) {
            text += "    Entry kbuffer_f;\n" + assignments("kbuffer_f", program_.entry, fragment_name, 0);
            text += call(Function::modify, fmt::format("modify(kbuffer_e{}, kbuffer_f);", state));
        }
        if (task == Task::drain) text += call(Function::drain, fmt::format("drain(kbuffer_e{});", state));
        return text + stored() + "}\n";
    }

  private:
    bool has_state() const { return !program_.state.empty(); }
    std::size_t floats() const { return program_.floats(k_); }

    std::string call(Function function, const std::string& statement) const {
        return fmt::format("#line {}\n    {}\n", program_.line_of(function), statement);
    }

    std::string declarations(bool before, bool fragment) const {
        const std::size_t targets = (floats() + 3) / 4;
        std::string text = fmt::format("out vec4 {}[{}];\n", after_name, targets);
        if (before) text += fmt::format("uniform vec4 {}[{}];\n", before_name, targets);
        if (fragment) text += fmt::format("uniform vec4 {}[{}];\n", fragment_name, (program_.entry.size() + 3) / 4);
        return text;
    }

    std::string entry() const {
        std::string text = fmt::format("out vec4 {}[{}];\nuniform vec4 {}[2];\nvoid main() {{\n", after_name,
                                       (program_.entry.size() + 3) / 4, fragment_name);
        text += call(Function::entry,
                     fmt::format("Entry kbuffer_f = entry(Fragment({0}[0], {0}[1].x, {0}[1].y));", fragment_name));
        return text +
               packed(
                   [&](std::size_t place) {
                       return place < program_.entry.size() ? "kbuffer_f." + program_.entry[place] : std::string("0.0");
                   },
                   program_.entry.size()) +
               "}\n";
    }

    std::string cleared() const {
        return call(Function::empty, "for (int i = 0; i < k; ++i) kbuffer_e[i] = empty();") +
               (has_state() ? call(Function::initial, "kbuffer_s = initial();") : "");
    }

    std::string fetched() const {
        std::string text;
        for (std::uint32_t i = 0; i < k_; ++i)
            text +=
                assignments(fmt::format("kbuffer_e[{}]", i), program_.entry, before_name, i * program_.entry.size());
        return text + assignments("kbuffer_s", program_.state, before_name, k_ * program_.entry.size());
    }

    std::string stored() const {
        return packed(
            [&](std::size_t place) -> std::string {
                const std::size_t i = place / program_.entry.size();
                if (i < k_) return fmt::format("kbuffer_e[{}].{}", i, program_.entry[place % program_.entry.size()]);
                const std::size_t field = place - k_ * program_.entry.size();
                return field < program_.state.size() ? "kbuffer_s." + program_.state[field] : "0.0";
            },
            floats());
    }

    template <class Name>
    static std::string packed(Name name, std::size_t count) {
        std::string text;
        for (std::size_t first = 0; first < count; first += 4)
            text += fmt::format("    {}[{}] = vec4({}, {}, {}, {});\n", after_name, first / 4, name(first),
                                name(first + 1), name(first + 2), name(first + 3));
        return text;
    }

    const Declaration& program_;
    std::uint32_t k_;
};

} // namespace

std::string task_text(const Declaration& program, Task task, std::uint32_t k, float opacity) {
    std::string text = "#version 450 core\n";
    text += fmt::format("const int k = {};\nconst float opacity = {:.9e}, largest = {:.9e};\n", k, opacity,
                        std::numeric_limits<float>::max());
    text += "struct Fragment { vec4 colour; float depth; float draw; };\n#line 1\n";
    return text + program.text + "\n" + TaskWriter(program, k).main(task);
}

} // namespace traces::shader_programs
