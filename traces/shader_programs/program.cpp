#include "traces/shader_programs/program.hpp"

#include "models/programs/finite.hpp"
#include "models/programs/pictures.hpp"
#include "sim/check.hpp"
#include "sim/random.hpp"
#include "traces/shader_programs/task_run.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>

namespace traces {

namespace shader_programs {

namespace {

using Pixel = std::array<float, std::size_t{pipeline::most_targets} * 4>;
constexpr std::size_t fragment_floats = 6; ///< colour, depth, draw

class ShaderProgram final : public pipeline::ModifyProgram {
  public:
    ShaderProgram(const Declaration& declaration, std::uint32_t entries, const TaskModules& modules)
        : ModifyProgram(entries, static_cast<std::uint32_t>(declaration.entry.size()),
                        static_cast<std::uint32_t>(declaration.state.size())),
          declaration_(declaration),
          make_entry_(shader_of(Task::entry, modules)),
          modify_(shader_of(Task::modify, modules)) {
        clear_.resize(floats_per_pixel());
        shader_of(Task::clear, modules)->run({}, {}, clear_);
        if (declaration_.drains()) drain_ = shader_of(Task::drain, modules);
        Pixel after{};
        const std::uint32_t copying = shader_of(Task::copy, modules)->run(clear_, {}, floats_of(after));
        const std::uint32_t longest = longest_run();
        cost_.operations = longest > copying ? longest - copying : 0;
    }

    std::string_view id() const override { return declaration_.id; }
    std::string_view summary() const override { return declaration_.summary; }
    pipeline::ProgramCost cost() const override { return cost_; }
    pipeline::OrderNeed order_need() const override { return declaration_.order; }
    bool needs_texture() const override { return false; }
    bool needs_colour() const override { return declaration_.needs_colour; }
    std::uint32_t depth_slot() const override { return declaration_.depth_slot(); }

    void clear(float* pixel) const override { std::copy(clear_.begin(), clear_.end(), pixel); }

    bool insert(float* pixel, const float* fragment) const override {
        return change(*modify_, pixel, {fragment, floats_per_entry()}).second;
    }

    void make_entry(const pipeline::Fragment& fragment, float* entry) const override {
        std::array<float, fragment_floats> inputs{};
        for (std::size_t i = 0; i < 4 && fragment.rgba != nullptr; ++i) inputs[i] = models::finite(fragment.rgba[i]);
        inputs[4] = models::finite(fragment.depth);
        inputs[5] = static_cast<float>(fragment.draw);
        make_entry_->run({}, inputs, {entry, floats_per_entry()});
    }

    bool drains() const override { return drain_ != nullptr; }
    void drain(float* pixel) const override {
        if (drain_ != nullptr) change(*drain_, pixel, {});
    }

    pipeline::Peeling peeling() const override { return declaration_.peeling; }

  private:
    std::unique_ptr<const TaskRun> shader_of(Task task, const TaskModules& modules) const {
        const std::size_t pixel = floats_per_pixel(), entry = floats_per_entry();
        TaskFloats floats{pixel, 0, pixel};
        if (task == Task::entry) floats = {0, fragment_floats, entry};
        if (task == Task::clear) floats = {0, 0, pixel};
        if (task == Task::modify) floats = {pixel, entry, pixel};
        try {
            return std::make_unique<const TaskRun>(modules[static_cast<std::size_t>(task)], floats, declaration_.name);
        } catch (const sim::InputError& error) {
            throw sim::InputError(fmt::format("{}: {}", declaration_.name, error.what()));
        }
    }

    std::span<float> floats_of(Pixel& pixel) const { return std::span(pixel).first(floats_per_pixel()); }

    /// Instructions, and whether a float of the pixel is another one now.
    std::pair<std::uint32_t, bool> change(const TaskRun& by, float* floats, std::span<const float> fragment) const {
        Pixel after{};
        const std::uint32_t instructions = by.run({floats, floats_per_pixel()}, fragment, floats_of(after));
        const bool changed = std::memcmp(floats, after.data(), bytes_per_pixel()) != 0;
        std::copy_n(after.begin(), floats_per_pixel(), floats);
        return {instructions, changed};
    }

    /// Of streams towards and away from the eye, of few depths, and in no order.
    std::uint32_t longest_run() const {
        constexpr std::uint32_t streams = 16;
        sim::Random random(1, "cost of a modify program");
        const auto number = [&] { return static_cast<float>(random.uniform()); };
        std::uint32_t longest = 0;
        for (std::uint32_t stream = 0; stream < streams; ++stream) {
            Pixel floats{};
            clear(floats.data());
            const std::uint32_t fragments = 2 * k() + 4;
            for (std::uint32_t i = 0; i < fragments; ++i) {
                const float place = static_cast<float>(i + 1) / static_cast<float>(fragments + 1);
                const std::array<float, 4> rgba{number(), number(), number(), number()};
                const std::array<float, 4> depths{place, 1.0F - place, static_cast<float>(i % 3) / 4.0F, number()};
                std::array<float, pipeline::largest_entry> entry{};
                make_entry({rgba.data(), depths[stream % 4], i % 2}, entry.data());
                longest = std::max(longest, change(*modify_, floats.data(), {entry.data(), floats_per_entry()}).first);
            }
            drain(floats.data());
        }
        return longest;
    }

    Declaration declaration_;
    std::unique_ptr<const TaskRun> make_entry_, modify_, drain_;
    std::vector<float> clear_;
    pipeline::ProgramCost cost_;
};

models::MakePicture picture_of(const Declaration& declaration) {
    if (declaration.picture == Picture::layers) return {};
    const bool of_state = declaration.picture == Picture::state;
    const Fields& fields = of_state ? declaration.state : declaration.entry;
    models::ColourSlots slots{};
    constexpr std::array names{"r", "g", "b", "t"};
    for (std::size_t i = 0; i < names.size(); ++i)
        slots[i] = static_cast<std::uint32_t>(std::find(fields.begin(), fields.end(), names[i]) - fields.begin());
    return of_state ? models::state_picture(slots) : models::node_picture(slots);
}

std::uint32_t entries_of(const Declaration& declaration, std::uint32_t k) {
    const std::uint32_t entries = k == 0 ? declaration.default_k : k;
    if (entries < declaration.least_k || entries > declaration.most_k)
        throw sim::InputError(fmt::format("{}: k: expected {}, got {}", declaration.name,
                                          declaration.least_k == declaration.most_k
                                              ? std::to_string(declaration.least_k)
                                              : fmt::format("{} to {}", declaration.least_k, declaration.most_k),
                                          entries));
    if (declaration.floats(entries) > std::size_t{pipeline::most_targets} * 4)
        throw sim::InputError(fmt::format("{}: k = {}: expected a pixel of {} floats or fewer, got {}",
                                          declaration.name, entries, pipeline::most_targets * 4,
                                          declaration.floats(entries)));
    return entries;
}

} // namespace

TaskModules compile_tasks(const Declaration& declaration, std::uint32_t k, float opacity,
                          const CompileShader& compile) {
    const std::uint32_t entries = entries_of(declaration, k);
    TaskModules modules;
    for (const Task task : {Task::entry, Task::clear, Task::copy, Task::modify, Task::drain})
        if (task != Task::drain || declaration.drains())
            modules[static_cast<std::size_t>(task)] =
                compile(task_text(declaration, task, entries, opacity), declaration.name);
    return modules;
}

models::ProgramChoice program_of(const Declaration& declaration, std::uint32_t k, const TaskModules& modules) {
    return {std::make_shared<const ShaderProgram>(declaration, entries_of(declaration, k), modules),
            picture_of(declaration)};
}

} // namespace shader_programs

models::ProgramChoice shader_program(std::string name, std::string text, std::uint32_t k, float opacity,
                                     const CompileShader& compile) {
    using namespace shader_programs;
    const Declaration declaration = declaration_of(std::move(name), std::move(text));
    return program_of(declaration, k, compile_tasks(declaration, k, opacity, compile));
}

} // namespace traces
