#include "traces/record_module/immediate.hpp"

#include "traces/record_module/context.hpp"
#include "traces/record_module/lists.hpp"
#include "traces/record_module/recorder.hpp"

#include <algorithm>
#include <optional>

namespace record {

using namespace record_stream;

namespace {

/// Between glBegin and glEnd of the calling thread.
struct Open {
    std::optional<PreparedDraw> prepared;
    Primitives primitives;
};
thread_local std::optional<Open> open_primitives;

/// The event that feeds a slot: attribute 0 is the vertex, too.
std::uint32_t feeding(std::uint32_t slot) { return slot == slot_generic ? std::uint32_t{slot_vertex} : slot; }

} // namespace

std::vector<VertexEvent>*& collected_events() {
    thread_local std::vector<VertexEvent>* events = nullptr;
    return events;
}

bool inside_primitives() { return open_primitives.has_value(); }

std::optional<PreparedDraw> prepare_primitives(const std::string& call) {
    auto prepared = prepare_draw(call);
    if (!prepared) return prepared;
    for (const std::uint32_t slot : prepared->slots) prepared->draw.geometry.arrays.emplace_back().slot = slot;
    read_current_values(prepared->draw.geometry);
    return prepared;
}

void record_primitives(PreparedDraw prepared, const Primitives& primitives) {
    std::array<std::uint32_t, slots> components{};
    for (const VertexEvent& event : primitives.events)
        components.at(event.slot) = std::max(components.at(event.slot), event.components);
    Geometry& geometry = prepared.draw.geometry;
    geometry.mode = primitives.mode;
    std::uint32_t stride = 0;
    std::array<std::array<float, 4>, slots> current{};
    for (Array& array : geometry.arrays) {
        current.at(array.slot) = array.current;
        array.components = components.at(feeding(array.slot));
        if (array.components == 0) continue;
        array.type = GL_FLOAT;
        array.offset = stride;
        stride += array.components * 4;
    }
    for (Array& array : geometry.arrays) array.stride = stride;
    std::vector<float> vertices;
    for (const VertexEvent& event : primitives.events) {
        current.at(event.slot) = event.value;
        if (event.slot != slot_vertex) continue;
        for (const Array& array : geometry.arrays) {
            const auto& value = current.at(feeding(array.slot));
            const std::size_t given = array.type == 0 ? 0 : array.components;
            vertices.insert(vertices.end(), value.begin(), value.begin() + given);
        }
        ++geometry.count;
    }
    if (geometry.count == 0) return;
    const std::int32_t blob = recorder().blob(std::as_bytes(std::span(vertices)));
    for (Array& array : geometry.arrays)
        if (array.type != 0) array.blob = blob;
    recorder().draw(prepared.draw);
}

} // namespace record

EXPORTED void glBegin(GLenum mode) {
    const record::Lock lock;
    if (record::list_is_compiled()) {
        record::compile_begin(mode);
        return;
    }
    if (record::recorder().wanted()) {
        const record::Quiet quiet;
        record::open_primitives.emplace();
        record::open_primitives->prepared = record::prepare_primitives("glBegin");
        record::open_primitives->primitives.mode = mode;
        record::collected_events() = &record::open_primitives->primitives.events;
    }
    REAL(glBegin)(mode);
}

EXPORTED void glEnd() {
    const record::Lock lock;
    if (record::list_is_compiled()) {
        record::compile_end();
        return;
    }
    REAL(glEnd)();
    if (!record::inside_primitives()) return;
    record::collected_events() = nullptr;
    const record::Quiet quiet;
    if (record::open_primitives->prepared)
        record::record_primitives(std::move(*record::open_primitives->prepared), record::open_primitives->primitives);
    record::open_primitives.reset();
}

// Materials that change from vertex to vertex would be attributes of a kind that there is not.
#define MATERIAL(function, type)                                                                                       \
    EXPORTED void function(GLenum face, GLenum name, type value) {                                                     \
        if (record::collected_events() != nullptr && !record::list_is_compiled())                                      \
            record::recorder().count(#function " between glBegin and glEnd");                                          \
        REAL(function)(face, name, value);                                                                             \
    }
MATERIAL(glMaterialf, GLfloat)
MATERIAL(glMaterialfv, const GLfloat*)
MATERIAL(glMateriali, GLint)
MATERIAL(glMaterialiv, const GLint*)
#undef MATERIAL
