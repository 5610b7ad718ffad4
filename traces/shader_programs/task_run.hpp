// One of a modify program's shaders, ready to run from any number of threads.
#pragma once

#include "traces/shader_programs/task_text.hpp"
#include "traces/spirv/quad.hpp"

#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace traces::shader_programs {

/// Floats that a shader is given at most, and that it writes at least.
struct TaskFloats {
    std::size_t before = 0, fragment = 0, after = 0;
};

class TaskRun {
  public:
    /// `name`: of the program, for messages of run(). Throws sim::InputError for modules that are none, do not have
    /// room for so many floats, or do what no modify program may.
    TaskRun(const std::vector<std::uint32_t>& words, const TaskFloats& floats, std::string name);

    /// Writes as many floats as `after` has, all of them finite; returns the instructions that it took.
    std::uint32_t run(std::span<const float> before, std::span<const float> fragment, std::span<float> after) const;

  private:
    struct Worker {
        explicit Worker(const spirv::Program& program);
        spirv::Quad quad;
        std::vector<std::uint32_t> uniforms;
    };
    static void set(Worker& worker, const std::optional<spirv::UniformPlace>& place, std::span<const float> floats);
    std::unique_ptr<Worker> take() const;

    std::string name_;
    spirv::Module module_;
    spirv::Program program_;
    std::optional<spirv::UniformPlace> before_, fragment_; ///< none where the shader does not read it
    const spirv::InterfaceVariable* after_ = nullptr;
    mutable std::mutex mutex_;
    mutable std::vector<std::unique_ptr<Worker>> idle_;
};

} // namespace traces::shader_programs
