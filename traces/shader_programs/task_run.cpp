#include "traces/shader_programs/task_run.hpp"

#include "models/programs/finite.hpp"
#include "sim/check.hpp"
#include "traces/shader_programs/program.hpp"

#include <bit>
#include <fmt/format.h>

namespace traces::shader_programs {

namespace {

/// A modify program has none; TaskRun refuses those that have.
class NoTextures final : public spirv::ShaderTextures {
  public:
    spirv::Texels sample(const spirv::TextureSample&) override { return {}; }
    spirv::Texels fetch(const spirv::TextureFetch&) override { return {}; }
    spirv::TextureSize size(std::uint32_t, std::uint32_t, std::int32_t) override { return {}; }
    std::int32_t levels(std::uint32_t, std::uint32_t) override { return 0; }
    std::int32_t samples(std::uint32_t, std::uint32_t) override { return 0; }
    spirv::Texels level(const spirv::TextureSample&) override { return {}; }
};

/// Uniform or output: an array of vectors of four floats, or one of them.
template <class Variable>
void expect_room(const Variable& variable, const char* name, std::size_t floats) {
    if (variable.kind != spirv::Kind::real || variable.components != 4 || variable.columns != 1 ||
        std::size_t{variable.elements} * 4 < floats)
        throw sim::InputError(fmt::format("expected {} as an array of {} vec4 or more", name, (floats + 3) / 4));
}

} // namespace

TaskRun::Worker::Worker(const spirv::Program& program)
    : quad(program, modify_budget), uniforms(program.uniform_words) {}

TaskRun::TaskRun(const std::vector<std::uint32_t>& words, const TaskFloats& floats, std::string name)
    : name_(std::move(name)),
      module_(words),
      program_(module_),
      before_(program_.uniform(module_, before_name)),
      fragment_(program_.uniform(module_, fragment_name)),
      after_(program_.output(after_name)) {
    if (after_ == nullptr) throw sim::InputError(fmt::format("expected a shader that writes {}", after_name));
    expect_room(*after_, after_name, floats.after);
    if (before_) expect_room(*before_, before_name, floats.before);
    if (fragment_) expect_room(*fragment_, fragment_name, floats.fragment);
    if (!program_.textures.empty())
        throw sim::InputError(
            fmt::format("expected a program without textures, got '{}'", program_.textures.front().name));
    if (program_.discards) throw sim::InputError("expected a program without discard");
}

std::unique_ptr<TaskRun::Worker> TaskRun::take() const {
    {
        const std::lock_guard lock(mutex_);
        if (!idle_.empty()) {
            std::unique_ptr<Worker> worker = std::move(idle_.back());
            idle_.pop_back();
            return worker;
        }
    }
    return std::make_unique<Worker>(program_);
}

void TaskRun::set(Worker& worker, const std::optional<spirv::UniformPlace>& place, std::span<const float> floats) {
    if (!place) return;
    CHECK(floats.size() <= std::size_t{place->elements} * 4);
    for (std::size_t i = 0; i < floats.size(); ++i)
        worker.uniforms[place->first + i / 4 * place->element_stride + i % 4 * place->stride] =
            std::bit_cast<std::uint32_t>(floats[i]);
}

// All four lanes do the same; the first is read.
std::uint32_t TaskRun::run(std::span<const float> before, std::span<const float> fragment,
                           std::span<float> after) const {
    std::unique_ptr<Worker> worker = take();
    set(*worker, before_, before);
    set(*worker, fragment_, fragment);
    worker->quad.set_uniforms(worker->uniforms);
    NoTextures textures;
    try {
        worker->quad.run(textures);
    } catch (const sim::InputError&) {
        throw sim::InputError(fmt::format("{}: a fragment takes more than {} instructions; expected loops that end",
                                          name_, modify_budget));
    }
    for (std::size_t i = 0; i < after.size(); ++i)
        after[i] = models::finite(worker->quad.get(*after_, static_cast<std::uint32_t>(i))[0]);
    const std::uint32_t instructions = worker->quad.instructions()[0];
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(worker));
    return instructions;
}

} // namespace traces::shader_programs
