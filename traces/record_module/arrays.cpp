#include "traces/record_module/arrays.hpp"

#include "traces/record_module/context.hpp"
#include "traces/record_module/element_types.hpp"
#include "traces/record_module/fixed_state_names.hpp"
#include "traces/record_module/recorder.hpp"

#include <algorithm>
#include <cstring>
#include <map>

namespace record {

using namespace record_stream;

namespace {

/// An array before its bytes are known.
struct Source {
    Array array;
    GLuint buffer = 0;
    const std::byte* memory = nullptr; ///< without a buffer
    std::uint32_t element = 0;         ///< bytes
};

/// Names of an old array's state.
struct OldArray {
    GLenum enabled, size, type, stride, buffer, pointer;
    GLint components; ///< where there is no state for it
    bool normalized;
};

constexpr OldArray old_array(std::uint32_t slot) {
    switch (slot) {
    case slot_vertex:
        return {GL_VERTEX_ARRAY,
                GL_VERTEX_ARRAY_SIZE,
                GL_VERTEX_ARRAY_TYPE,
                GL_VERTEX_ARRAY_STRIDE,
                GL_VERTEX_ARRAY_BUFFER_BINDING,
                GL_VERTEX_ARRAY_POINTER,
                0,
                false};
    case slot_normal:
        return {GL_NORMAL_ARRAY,
                0,
                GL_NORMAL_ARRAY_TYPE,
                GL_NORMAL_ARRAY_STRIDE,
                GL_NORMAL_ARRAY_BUFFER_BINDING,
                GL_NORMAL_ARRAY_POINTER,
                3,
                true};
    case slot_colour:
        return {GL_COLOR_ARRAY,
                GL_COLOR_ARRAY_SIZE,
                GL_COLOR_ARRAY_TYPE,
                GL_COLOR_ARRAY_STRIDE,
                GL_COLOR_ARRAY_BUFFER_BINDING,
                GL_COLOR_ARRAY_POINTER,
                0,
                true};
    case slot_secondary:
        return {GL_SECONDARY_COLOR_ARRAY,
                GL_SECONDARY_COLOR_ARRAY_SIZE,
                GL_SECONDARY_COLOR_ARRAY_TYPE,
                GL_SECONDARY_COLOR_ARRAY_STRIDE,
                GL_SECONDARY_COLOR_ARRAY_BUFFER_BINDING,
                GL_SECONDARY_COLOR_ARRAY_POINTER,
                0,
                true};
    case slot_fog:
        return {GL_FOG_COORD_ARRAY,
                0,
                GL_FOG_COORD_ARRAY_TYPE,
                GL_FOG_COORD_ARRAY_STRIDE,
                GL_FOG_COORD_ARRAY_BUFFER_BINDING,
                GL_FOG_COORD_ARRAY_POINTER,
                1,
                false};
    default:
        return {GL_TEXTURE_COORD_ARRAY,
                GL_TEXTURE_COORD_ARRAY_SIZE,
                GL_TEXTURE_COORD_ARRAY_TYPE,
                GL_TEXTURE_COORD_ARRAY_STRIDE,
                GL_TEXTURE_COORD_ARRAY_BUFFER_BINDING,
                GL_TEXTURE_COORD_ARRAY_POINTER,
                0,
                false};
    }
}

/// Selects the texture coordinates of a unit for queries, and puts the program's choice back.
class ClientUnit {
  public:
    explicit ClientUnit(std::uint32_t slot) {
        if (slot < slot_texcoord || slot >= slot_generic) return;
        kept_ = integer(GL_CLIENT_ACTIVE_TEXTURE);
        REAL(glClientActiveTexture)(GL_TEXTURE0 + slot - slot_texcoord);
    }
    ~ClientUnit() {
        if (kept_ != 0) REAL(glClientActiveTexture)(static_cast<GLenum>(kept_));
    }
    ClientUnit(const ClientUnit&) = delete;
    ClientUnit& operator=(const ClientUnit&) = delete;

  private:
    GLint kept_ = 0;
};

/// Its type stays 0 where it is not enabled.
void read_old_array(Source& source, std::uint32_t slot) {
    const ClientUnit unit(slot);
    const OldArray names = old_array(slot);
    if (REAL(glIsEnabled)(names.enabled) == GL_FALSE) return;
    source.array.components = static_cast<std::uint32_t>(names.size != 0 ? integer(names.size) : names.components);
    source.array.type = static_cast<std::uint32_t>(integer(names.type));
    source.array.stride = static_cast<std::uint32_t>(integer(names.stride));
    source.array.normalized = names.normalized && source.array.type != GL_FLOAT && source.array.type != GL_DOUBLE;
    source.buffer = static_cast<GLuint>(integer(names.buffer));
    void* pointer = nullptr;
    REAL(glGetPointerv)(names.pointer, &pointer);
    if (source.buffer == 0)
        source.memory = static_cast<const std::byte*>(pointer);
    else
        source.array.offset = reinterpret_cast<std::uintptr_t>(pointer);
}

GLint of_attribute(GLuint index, GLenum name) {
    GLint value = 0;
    REAL(glGetVertexAttribiv)(index, name, &value);
    return value;
}

bool read_numbered_array(Source& source, GLuint index) {
    const auto ask = [&](GLenum name) { return static_cast<std::uint32_t>(of_attribute(index, name)); };
    if (ask(GL_VERTEX_ATTRIB_ARRAY_ENABLED) == 0) return false;
    source.array.components = ask(GL_VERTEX_ATTRIB_ARRAY_SIZE);
    source.array.type = ask(GL_VERTEX_ATTRIB_ARRAY_TYPE);
    source.array.normalized = ask(GL_VERTEX_ATTRIB_ARRAY_NORMALIZED) != 0;
    source.array.integer = ask(GL_VERTEX_ATTRIB_ARRAY_INTEGER) != 0;
    source.array.divisor = ask(GL_VERTEX_ATTRIB_ARRAY_DIVISOR);
    source.buffer = ask(GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING);
    if (source.buffer == 0) {
        void* pointer = nullptr;
        REAL(glGetVertexAttribPointerv)(index, GL_VERTEX_ATTRIB_ARRAY_POINTER, &pointer);
        source.memory = static_cast<const std::byte*>(pointer);
        source.array.stride = ask(GL_VERTEX_ATTRIB_ARRAY_STRIDE);
        return true;
    }
    const auto binding = static_cast<GLuint>(ask(GL_VERTEX_ATTRIB_BINDING));
    GLint64 offset = 0;
    REAL(glGetInteger64i_v)(GL_VERTEX_BINDING_OFFSET, binding, &offset);
    source.array.offset = static_cast<std::uint64_t>(offset) + ask(GL_VERTEX_ATTRIB_RELATIVE_OFFSET);
    source.array.stride = static_cast<std::uint32_t>(integer_at(GL_VERTEX_BINDING_STRIDE, binding));
    source.array.divisor = static_cast<std::uint32_t>(integer_at(GL_VERTEX_BINDING_DIVISOR, binding));
    return true;
}

std::uint32_t index_at(const std::byte* bytes, GLenum type, std::size_t i) {
    const std::size_t size = index_bytes(type);
    std::uint32_t value = 0;
    std::memcpy(&value, bytes + i * size, size); // little-endian
    return value;
}

/// One behind the largest vertex that a draw names.
std::uint64_t vertices_used(const Geometry& geometry, std::span<const std::byte> indices) {
    if (geometry.index_type == 0) return std::uint64_t{geometry.first} + geometry.count;
    std::int64_t most = 0;
    const std::size_t size = index_bytes(geometry.index_type);
    for (std::size_t i = 0; i < geometry.count && geometry.index_offset + (i + 1) * size <= indices.size(); ++i) {
        const std::uint32_t index = index_at(indices.data() + geometry.index_offset, geometry.index_type, i);
        if (geometry.restart && index == geometry.restart_index) continue;
        most = std::max(most, std::int64_t{index} + geometry.base_vertex + 1);
    }
    return static_cast<std::uint64_t>(most);
}

/// Arrays in the memory of the process that lie in each other's gaps are one range of bytes.
void read_memory(std::vector<Source*>& sources, std::uint64_t vertices, const Geometry& geometry) {
    std::sort(sources.begin(), sources.end(), [](const Source* a, const Source* b) { return a->memory < b->memory; });
    for (std::size_t begin = 0; begin < sources.size();) {
        const Source& first = *sources[begin];
        const std::byte* last = first.memory;
        std::size_t end = begin;
        for (; end < sources.size(); ++end) {
            const Source& other = *sources[end];
            if (end > begin &&
                (other.array.stride != first.array.stride || other.array.divisor != first.array.divisor ||
                 other.memory >= first.memory + first.array.stride))
                break;
            const std::uint64_t elements =
                other.array.divisor == 0 ? vertices
                                         : geometry.base_instance + (geometry.instances - 1) / other.array.divisor + 1;
            if (elements > 0) last = std::max(last, other.memory + (elements - 1) * other.array.stride + other.element);
        }
        const std::int32_t blob = recorder().blob({first.memory, last});
        for (std::size_t i = begin; i < end; ++i) {
            sources[i]->array.blob = blob;
            sources[i]->array.offset = static_cast<std::uint64_t>(sources[i]->memory - first.memory);
        }
        begin = end;
    }
}

void add_indices(Geometry& geometry, const DrawCall& call, std::vector<std::byte>& indices) {
    geometry.index_type = call.index_type;
    geometry.base_vertex = call.base_vertex;
    const auto buffer = static_cast<GLuint>(integer(GL_ELEMENT_ARRAY_BUFFER_BINDING));
    if (buffer != 0) {
        indices = buffer_bytes(buffer);
        geometry.index_offset = reinterpret_cast<std::uintptr_t>(call.indices);
    } else {
        const auto* memory = static_cast<const std::byte*>(call.indices);
        indices.assign(memory, memory + static_cast<std::size_t>(call.count) * index_bytes(call.index_type));
    }
    geometry.index_blob = recorder().blob(indices);
    const bool fixed = REAL(glIsEnabled)(GL_PRIMITIVE_RESTART_FIXED_INDEX) != GL_FALSE;
    geometry.restart = fixed || REAL(glIsEnabled)(GL_PRIMITIVE_RESTART) != GL_FALSE;
    geometry.restart_index = fixed ? 0xFFFFFFFFU >> (32 - 8 * index_bytes(call.index_type))
                                   : static_cast<std::uint32_t>(integer(GL_PRIMITIVE_RESTART_INDEX));
}

} // namespace

std::vector<std::byte> buffer_bytes(GLuint buffer) {
    GLint64 size = 0;
    GLint mapped = 0, flags = 0;
    REAL(glGetNamedBufferParameteri64v)(buffer, GL_BUFFER_SIZE, &size);
    REAL(glGetNamedBufferParameteriv)(buffer, GL_BUFFER_MAPPED, &mapped);
    REAL(glGetNamedBufferParameteriv)(buffer, GL_BUFFER_ACCESS_FLAGS, &flags);
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    if (mapped != 0 && (static_cast<GLuint>(flags) & GL_MAP_PERSISTENT_BIT) == 0) {
        recorder().count("draws from mapped buffers");
        return {};
    }
    if (size > 0) REAL(glGetNamedBufferSubData)(buffer, 0, size, bytes.data());
    return bytes;
}

std::array<float, 4> current_value(std::uint32_t slot) {
    std::array<float, 4> value{0.0F, 0.0F, 0.0F, 1.0F};
    const auto ask = [&](GLenum name) { REAL(glGetFloatv)(name, value.data()); };
    if (slot == slot_normal) ask(GL_CURRENT_NORMAL);
    if (slot == slot_colour) ask(GL_CURRENT_COLOR);
    if (slot == slot_secondary) ask(GL_CURRENT_SECONDARY_COLOR);
    if (slot == slot_fog) ask(GL_CURRENT_FOG_COORD);
    if (slot >= slot_texcoord && slot < slot_generic) {
        const GLint active = integer(GL_ACTIVE_TEXTURE);
        REAL(glActiveTexture)(GL_TEXTURE0 + slot - slot_texcoord);
        ask(GL_CURRENT_TEXTURE_COORDS);
        REAL(glActiveTexture)(static_cast<GLenum>(active));
    }
    // In compatibility profiles number 0 is the vertex itself and has no current value.
    if (slot >= slot_generic && (slot > slot_generic || !current_context().compatibility))
        REAL(glGetVertexAttribfv)(slot - slot_generic, GL_CURRENT_VERTEX_ATTRIB, value.data());
    return value;
}

void read_current_values(Geometry& geometry) {
    for (Array& array : geometry.arrays)
        if (array.blob < 0) array.current = current_value(array.slot);
}

std::vector<std::uint32_t> slots_of(const KnownProgram* program) {
    std::vector<std::uint32_t> slots;
    if (program == nullptr) {
        for (std::uint32_t slot = slot_vertex; slot < slot_generic; ++slot) slots.push_back(slot);
        return slots;
    }
    const auto add = [&](std::uint32_t slot) {
        if (slot < record_stream::slots && std::find(slots.begin(), slots.end(), slot) == slots.end())
            slots.push_back(slot);
    };
    static const std::map<std::string, std::uint32_t> old_names{
        {"gl_Vertex", slot_vertex}, {"gl_Normal", slot_normal},
        {"gl_Color", slot_colour},  {"gl_SecondaryColor", slot_secondary},
        {"gl_FogCoord", slot_fog},
    };
    constexpr const char* coordinates = "gl_MultiTexCoord";
    for (const Variable& attribute : program->attributes) {
        if (attribute.location >= 0) {
            std::uint32_t columns = 1; // a matrix has a number for each
            if (attribute.type == GL_FLOAT_MAT2 || attribute.type == GL_FLOAT_MAT2x3 ||
                attribute.type == GL_FLOAT_MAT2x4)
                columns = 2;
            if (attribute.type == GL_FLOAT_MAT3 || attribute.type == GL_FLOAT_MAT3x2 ||
                attribute.type == GL_FLOAT_MAT3x4)
                columns = 3;
            if (attribute.type == GL_FLOAT_MAT4 || attribute.type == GL_FLOAT_MAT4x2 ||
                attribute.type == GL_FLOAT_MAT4x3)
                columns = 4;
            for (std::uint32_t i = 0; i < columns; ++i)
                add(slot_generic + static_cast<std::uint32_t>(attribute.location) + i);
        } else if (const auto old = old_names.find(attribute.name); old != old_names.end()) {
            add(old->second);
        } else if (attribute.name.starts_with(coordinates)) {
            add(slot_texcoord + static_cast<std::uint32_t>(attribute.name.back() - '0'));
        }
    }
    return slots;
}

Geometry geometry_of(const DrawCall& call, const std::vector<std::uint32_t>& slots) {
    Geometry geometry;
    geometry.mode = call.mode;
    geometry.first = static_cast<std::uint32_t>(call.first);
    geometry.count = static_cast<std::uint32_t>(call.count);
    geometry.instances = static_cast<std::uint32_t>(call.instances);
    geometry.base_instance = call.base_instance;
    std::vector<std::byte> indices;
    if (call.index_type != 0) add_indices(geometry, call, indices);
    std::vector<Source> sources;
    for (const std::uint32_t slot : slots) {
        Source& source = sources.emplace_back();
        source.array.slot = slot;
        // Attribute 0 takes the place of the old one.
        const bool is_vertex = slot == slot_vertex && read_numbered_array(source, 0);
        if (!is_vertex && slot < slot_generic) read_old_array(source, slot);
        if (slot >= slot_generic) read_numbered_array(source, slot - slot_generic);
        if (source.array.type == 0) continue;
        source.element = element_bytes(source.array);
        if (source.array.stride == 0 && (source.buffer == 0 || slot < slot_generic))
            source.array.stride = source.element;
    }
    std::map<GLuint, std::int32_t> buffers;
    std::vector<Source*> in_memory;
    for (Source& source : sources) {
        if (source.array.type == 0) continue;
        if (source.buffer == 0 && source.memory != nullptr) in_memory.push_back(&source);
        if (source.buffer == 0) continue;
        const auto [place, is_new] = buffers.try_emplace(source.buffer, -1);
        if (is_new) place->second = recorder().blob(buffer_bytes(source.buffer));
        source.array.blob = place->second;
    }
    if (!in_memory.empty()) read_memory(in_memory, vertices_used(geometry, indices), geometry);
    for (const Source& source : sources) geometry.arrays.push_back(source.array);
    return geometry;
}

} // namespace record
