// What the library inside a recorded program tells ropsim: records, one behind the other, in OpenGL's own words.
//
// A record is a u32 tag, a u64 length and its fields in the order of fields(): numbers as they lie in memory, texts and
// lists behind their u32 length. Both ends run on one machine and are of one build. Blobs, surfaces and programs are
// known by the order in which they come; a record names only those before it; -1 names none.
#pragma once

#include "traces/record_module/stream_objects.hpp"

namespace record_stream {

/// With which a program ends whose recording cannot be written.
inline constexpr int status_no_room = 120;

enum class Tag : std::uint32_t {
    context,
    blob,
    surface,
    program,
    draw,
    clear,
    copy,
    blit,
    frame,
    not_recorded,
    finished
};

struct Target {
    std::int32_t surface = -1;
    std::uint32_t level = 0, layer = 0;

    void fields(auto& archive) { archive(surface, level, layer); }
};

inline constexpr std::size_t most_targets = 8;

struct Targets {
    std::array<Target, most_targets> colours;
    Target depth, stencil;
    std::uint32_t width = 0, height = 0;
    bool window = false;

    void fields(auto& archive) { archive(colours, depth, stencil, width, height, window); }
};

/// Vertex attributes: the old ones, then the numbered ones.
enum Slot : std::uint32_t {
    slot_vertex,
    slot_normal,
    slot_colour,
    slot_secondary,
    slot_fog,
    slot_texcoord,
    slot_generic = slot_texcoord + 8,
    slots = slot_generic + 16
};

struct Array {
    std::uint32_t slot = 0;
    std::int32_t blob = -1;                                          ///< -1: no array; every vertex has `current`
    std::uint32_t components = 4, type = 0, stride = 0, divisor = 0; ///< GL_BGRA counts as components, too
    std::uint64_t offset = 0;
    bool normalized = false, integer = false;
    std::array<float, 4> current{0.0F, 0.0F, 0.0F, 1.0F};

    void fields(auto& archive) {
        archive(slot, blob, components, type, stride, divisor, offset, normalized, integer, current);
    }
};

struct Geometry {
    std::uint32_t mode = 0, first = 0, count = 0;
    std::uint32_t index_type = 0; ///< 0: none
    std::int32_t index_blob = -1;
    std::uint64_t index_offset = 0;
    std::int32_t base_vertex = 0; ///< to be added to each index
    bool restart = false;
    std::uint32_t restart_index = 0;
    std::uint32_t instances = 1, base_instance = 0;
    std::vector<Array> arrays;

    void fields(auto& archive) {
        archive(mode, first, count, index_type, index_blob, index_offset, base_vertex, restart, restart_index,
                instances, base_instance, arrays);
    }
};

struct Value {
    std::string name;
    std::uint32_t type = 0;
    std::vector<std::uint32_t> words;

    void fields(auto& archive) { archive(name, type, words); }
};

struct Sampler {
    std::array<std::uint32_t, 3> wrap{};
    std::uint32_t min_filter = 0, mag_filter = 0, compare_mode = 0, compare_func = 0;
    std::array<float, 4> border{};
    float lod_bias = 0.0F, least_lod = 0.0F, most_lod = 0.0F, anisotropy = 1.0F;

    void fields(auto& archive) {
        archive(wrap, min_filter, mag_filter, compare_mode, compare_func, border, lod_bias, least_lod, most_lod,
                anisotropy);
    }
};

struct Binding {
    std::string variable; ///< empty: of the fixed-function unit `element`
    std::uint32_t element = 0;
    std::int32_t surface = -1;
    Sampler sampler;
    std::array<std::uint32_t, 4> swizzle{};
    std::uint32_t base_level = 0, last_level = 1000, depth_mode = 0;

    void fields(auto& archive) {
        archive(variable, element, surface, sampler, swizzle, base_level, last_level, depth_mode);
    }
};

/// Of one colour target; the constant of blending is in State::values.
struct TargetState {
    bool blend = false;
    std::uint32_t source_colour = 0, target_colour = 0, source_alpha = 0, target_alpha = 0, equation_colour = 0,
                  equation_alpha = 0, write_mask = 0xF;

    void fields(auto& archive) {
        archive(blend, source_colour, target_colour, source_alpha, target_alpha, equation_colour, equation_alpha,
                write_mask);
    }
};

struct State {
    bool compatibility = false;
    std::vector<double> values; ///< in the order of state_names
    std::array<TargetState, most_targets> targets;

    void fields(auto& archive) { archive(compatibility, values, targets); }
};

/// State of processing without shaders, in the order of the tables in fixed_state.hpp.
struct FixedFunction {
    std::vector<double> values;
    std::vector<std::vector<double>> lights, materials, units;

    void fields(auto& archive) { archive(values, lights, materials, units); }
};

struct Draw {
    std::string call;
    Targets targets;
    Geometry geometry;
    std::int32_t program = -1; ///< -1: fixed function
    std::vector<Value> values, blocks;
    std::vector<Binding> bindings;
    State state;
    std::vector<FixedFunction> fixed; ///< one, where the draw depends on it

    void fields(auto& archive) { archive(call, targets, geometry, program, values, blocks, bindings, state, fixed); }
};

struct Clear {
    std::string call;
    Targets targets;
    State state;
    std::uint32_t colours = 0; ///< bit i: target i
    std::array<float, 4> colour{};
    bool depth = false, stencil = false;
    float depth_value = 0.0F;
    std::int32_t stencil_value = 0;

    void fields(auto& archive) {
        archive(call, targets, state, colours, colour, depth, stencil, depth_value, stencil_value);
    }
};

/// Rows count from the bottom.
struct Copy {
    std::string call;
    Target from, to;
    std::int32_t x = 0, y = 0, to_x = 0, to_y = 0;
    std::uint32_t width = 0, height = 0;

    void fields(auto& archive) { archive(call, from, to, x, y, to_x, to_y, width, height); }
};

/// A copy that scales, turns or is cut. Rectangles are two corners, rows counted from the bottom; either may run
/// backwards.
struct Blit {
    std::string call;
    Target from, to;
    std::array<std::int32_t, 4> source{}, destination{};
    bool linear = false, scissor_test = false;
    std::array<std::int32_t, 4> scissor{}; ///< corner, width and height

    void fields(auto& archive) { archive(call, from, to, source, destination, linear, scissor_test, scissor); }
};

/// A frame ends.
struct Frame {
    std::uint32_t number = 0;
    Targets shown;

    void fields(auto& archive) { archive(number, shown); }
};

struct NotRecorded {
    std::string call;
    std::uint64_t times = 0;

    void fields(auto& archive) { archive(call, times); }
};

/// The last frame that was wanted is there.
struct Finished {
    void fields(auto& archive) { archive(); }
};

} // namespace record_stream
