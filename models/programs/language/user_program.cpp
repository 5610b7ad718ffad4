#include "models/programs/language/user_program.hpp"

#include "models/programs/finite.hpp"
#include "models/programs/language/checker.hpp"
#include "models/programs/language/interpreter.hpp"
#include "models/programs/language/parser.hpp"
#include "models/programs/pictures.hpp"
#include "models/programs/program_file.hpp"
#include "ropsim_build.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace models {

namespace {

class UserProgram final : public pipeline::ModifyProgram {
  public:
    UserProgram(language::Program program, language::CompiledProgram&& compiled, std::uint32_t entries)
        : ModifyProgram(entries, static_cast<std::uint32_t>(program.entry.size()),
                        static_cast<std::uint32_t>(program.state.size())),
          program_(std::move(program)),
          clear_(std::move(compiled.clear)),
          make_entry_(compiled.make_entry),
          insert_(compiled.insert),
          drain_(compiled.drain),
          cost_{language::longest_path(compiled.insert)} {}

    std::string_view id() const override { return program_.id; }
    std::string_view summary() const override { return program_.summary; }
    pipeline::ProgramCost cost() const override { return cost_; }
    pipeline::OrderNeed order_need() const override { return program_.order; }
    bool needs_texture() const override { return false; }
    bool needs_colour() const override { return program_.needs_colour; }
    std::uint32_t depth_slot() const override { return program_.depth_slot; }

    void clear(float* pixel) const override { std::copy(clear_.begin(), clear_.end(), pixel); }

    bool insert(float* pixel, const float* fragment) const override {
        return insert_.run(pixel, {fragment, floats_per_entry()});
    }

    void make_entry(const pipeline::Fragment& fragment, float* entry) const override {
        std::array<float, std::size(language::shader_fields)> inputs{};
        for (std::size_t i = 0; i < 4 && fragment.rgba != nullptr; ++i) inputs[i] = finite(fragment.rgba[i]);
        inputs[4] = finite(fragment.depth);
        inputs[5] = static_cast<float>(fragment.draw);
        std::fill_n(entry, floats_per_entry(), 0.0F);
        make_entry_.run(entry, inputs);
    }

    bool drains() const override { return program_.has_drain; }
    void drain(float* pixel) const override { drain_.run(pixel, {}); }

    pipeline::Peeling peeling() const override { return program_.peeling; }

  private:
    language::Program program_;
    std::vector<float> clear_;
    language::Script make_entry_, insert_, drain_;
    pipeline::ProgramCost cost_;
};

MakePicture picture_of(const language::Program& program) {
    if (program.picture == language::Picture::layers) return {};
    const bool of_state = program.picture == language::Picture::state;
    const auto& fields = of_state ? program.state : program.entry;
    ColourSlots slots{};
    constexpr std::array<std::string_view, 4> names{"r", "g", "b", "t"};
    for (std::size_t i = 0; i < names.size(); ++i)
        slots[i] = static_cast<std::uint32_t>(
            std::find_if(fields.begin(), fields.end(), [&](const auto& field) { return field.name == names[i]; }) -
            fields.begin());
    return of_state ? state_picture(slots) : node_picture(slots);
}

} // namespace

ProgramChoice user_program(std::string name, std::string text, std::uint32_t k, const language::Overrides& overrides) {
    language::Program program = language::parse({std::move(name), std::move(text)});
    language::check(program);
    const std::uint32_t entries = k == 0 ? program.default_k : k;
    if (entries < program.least_k || entries > program.most_k)
        throw sim::InputError(fmt::format("{}: k: expected {}, got {}", program.source.name,
                                          program.least_k == program.most_k
                                              ? std::to_string(program.least_k)
                                              : fmt::format("{} to {}", program.least_k, program.most_k),
                                          entries));
    language::CompiledProgram compiled = language::compile(program, entries, overrides);
    auto picture = picture_of(program);
    return {std::make_shared<const UserProgram>(std::move(program), std::move(compiled), entries), std::move(picture)};
}

bool is_user_program(std::string_view program) { return program_name(program).ends_with(".kb"); }

ProgramChoice load_user_program(std::string_view program, std::uint32_t k, const language::Overrides& overrides) {
    return user_program(std::string(program_name(program)), program_text(program), k, overrides);
}

std::vector<std::string> shipped_user_programs() { return ropsim_build::data_files("models/programs", ".kb"); }

} // namespace models
