// Vertices that are specified one call at a time, between glBegin and glEnd.
#pragma once

#include "traces/record_module/draws.hpp"

#include <optional>
#include <string>
#include <vector>

namespace record {

/// An attribute gets a value; of slot_vertex: a vertex is made of all current values.
struct VertexEvent {
    std::uint32_t slot = 0, components = 0;
    std::array<float, 4> value{};
};

struct Primitives {
    GLenum mode = 0;
    std::vector<VertexEvent> events;
};

/// The same with the attributes' values that are current, in the geometry.
std::optional<PreparedDraw> prepare_primitives(const std::string& call);

/// Emits them as a draw, as it was prepared before them.
void record_primitives(PreparedDraw prepared, const Primitives& primitives);

/// What the calling thread collects now; null: nothing.
std::vector<VertexEvent>*& collected_events();

/// A call that sets an attribute.
inline void attribute(std::uint32_t slot, std::uint32_t components, float x, float y = 0.0F, float z = 0.0F,
                      float w = 1.0F) {
    if (std::vector<VertexEvent>* const events = collected_events())
        events->push_back({slot, components, {x, y, z, w}});
}

/// Whether the calling thread is between glBegin and glEnd, outside of a display list, and that is recorded.
bool inside_primitives();

} // namespace record
