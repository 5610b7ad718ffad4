// The vertices of a draw.
#pragma once

#include "traces/record_module/functions.hpp"
#include "traces/record_module/programs.hpp"
#include "traces/record_module/stream.hpp"

#include <vector>

namespace record {

/// As the application called it.
struct DrawCall {
    const char* name = "";
    GLenum mode = 0;
    GLint first = 0;
    GLsizei count = 0;
    GLenum index_type = 0; ///< 0: none
    const void* indices = nullptr;
    GLint base_vertex = 0;
    GLsizei instances = 1;
    GLuint base_instance = 0;
};

/// Slots of the attributes that a program reads; of fixed function those that there are.
std::vector<std::uint32_t> slots_of(const KnownProgram* program);

/// Reads buffers whole, memory of the process as far as the draw uses it.
record_stream::Geometry geometry_of(const DrawCall& call, const std::vector<std::uint32_t>& slots);

/// What a vertex has where there is no array. Not while a display list is compiled.
std::array<float, 4> current_value(std::uint32_t slot);
void read_current_values(record_stream::Geometry& geometry);

/// The bytes of a buffer; empty where it cannot be read.
std::vector<std::byte> buffer_bytes(GLuint buffer);

} // namespace record
