// Programs: the sources that they were linked from, and what is fed to them at a draw.
#pragma once

#include "traces/record_module/functions.hpp"
#include "traces/record_module/stream.hpp"

#include <string>
#include <vector>

namespace record {

/// A uniform outside of blocks; of an array, one for each element.
struct Uniform {
    std::string name; ///< of the array, without its index
    GLenum type = 0;
    std::vector<GLint> locations; ///< of the elements; none: a built-in one
};

struct UniformBlock {
    std::string name;
    GLuint index = 0;
};

/// A linked program as the recording has it.
struct KnownProgram {
    std::int32_t number = -1;
    std::string problem; ///< why it cannot be recorded
    std::vector<Uniform> uniforms;
    std::vector<UniformBlock> blocks;
    std::vector<record_stream::Variable> attributes;
    bool reads_built_in = false; ///< old built-in uniforms
};

/// Reads it the first time after it was linked.
const KnownProgram& known_program(GLuint program);

std::vector<record_stream::Value> values_of(GLuint program, const KnownProgram& known);
std::vector<record_stream::Value> blocks_of(GLuint program, const KnownProgram& known);
std::vector<record_stream::Binding> bindings_of(GLuint program, const KnownProgram& known);
/// Of fixed-function units.
std::vector<record_stream::Binding> fixed_function_bindings();

} // namespace record
