// A vertex and a fragment shader of a recording, read, and the varyings between them in the vectors that the pipeline
// carries.
//
// Modelled: varyings by name, else by location; flat ones, and those without perspective. Not modelled: interpolation
// at centroids or samples, which is at the place that the rasterizer chooses.
#pragma once

#include "traces/recording/recording.hpp"
#include "traces/spirv/quad.hpp"
#include "traces/spirv/register_pressure.hpp"

#include <memory>
#include <string>
#include <vector>

namespace traces {

/// A module with its entry point.
struct ShaderStage {
    spirv::Module module;
    spirv::Program program;
    std::uint32_t registers; ///< of 128 bits

    explicit ShaderStage(const std::vector<std::uint32_t>& words)
        : module(words), program(module), registers(register_pressure(module)) {}

    /// The words of its uniforms. Values that it does not have are left out; what nobody gave is 0.
    std::vector<std::uint32_t> uniform_words(const std::vector<UniformValue>& values) const;
};

/// A vector that the fragment shader reads: where it stands at both borders.
struct LinkedVarying {
    const spirv::InterfaceVariable* input = nullptr;  ///< of the fragment shader
    const spirv::InterfaceVariable* output = nullptr; ///< of the vertex shader; null: it writes none, which reads 0
    std::uint32_t first = 0;                          ///< scalar of both where the vector begins
    std::uint32_t components = 4;
};

struct LinkedProgram {
    std::string name;
    std::unique_ptr<const ShaderStage> vertex, fragment; ///< no fragment shader: none is run
    std::vector<LinkedVarying> varyings;
    std::vector<std::string> notes; ///< what is not drawn as it was recorded, one line each

    /// Throws sim::InputError naming the program where a module is none, or more than the pipeline carries.
    explicit LinkedProgram(const RecordedProgram& program);
    LinkedProgram(const LinkedProgram&) = delete;
    LinkedProgram& operator=(const LinkedProgram&) = delete;
};

/// The numbers that SPIR-V gives to built-in variables (specification 1.6, section 3.21).
namespace built_in {
inline constexpr std::uint32_t position = 0, point_size = 1, clip_distance = 3, vertex_id = 5, instance_id = 6,
                               primitive_id = 7, frag_coord = 15, point_coord = 16, front_facing = 17, sample_mask = 20,
                               frag_depth = 22, vertex_index = 42, instance_index = 43, base_vertex = 4424,
                               base_instance = 4425;
} // namespace built_in

} // namespace traces
