#include "traces/record_module/lists.hpp"

#include "traces/record_module/context.hpp"
#include "traces/record_module/immediate.hpp"
#include "traces/record_module/recorder.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <variant>

namespace record {

using namespace record_stream;

namespace {

/// Calls that set attributes outside of glBegin and glEnd; they count where the list is called in between.
struct LooseEvents {
    std::vector<VertexEvent> events;
};
/// Draws from arrays as they were when the list was compiled.
struct ArrayDraws {
    std::vector<std::pair<std::string, Geometry>> draws;
};
/// Lists that are called: by name, or to be added to the list base.
struct Calls {
    std::vector<GLuint> lists;
    bool add_base = false;
};

struct Piece {
    GLuint list = 0; ///< the driver's; 0: none
    std::variant<LooseEvents, Primitives, ArrayDraws, Calls> content;
};

struct Compiling {
    GLuint name = 0;
    GLenum mode = GL_COMPILE;
    std::vector<Piece> pieces;
};
thread_local std::optional<Compiling> compiling;

using Key = std::pair<std::uint64_t, GLuint>; // context and name
std::map<Key, std::vector<Piece>>& lists() {
    static auto* const all = new std::map<Key, std::vector<Piece>>;
    return *all;
}
Key key_of(GLuint list) { return {current_context().number, list}; }

/// Names of our own. They begin at the top: behind the largest one in use there is no room, so that glGenLists searches
/// for free ones from 1 on.
constexpr GLuint first_hidden = 0x80000000, last_hidden = 0xFFFFFFFE;
constexpr int deepest = 64; ///< GL_MAX_LIST_NESTING is that or more

GLuint hidden_list() {
    static GLuint next = last_hidden;
    return next--;
}

/// Goes on in a list of the driver's own.
void begin_piece(GLuint list) {
    REAL(glNewList)(list, GL_COMPILE);
    Piece& piece = compiling->pieces.emplace_back();
    piece.list = list;
    collected_events() = &std::get<LooseEvents>(piece.content).events;
}

void next_piece() {
    REAL(glEndList)();
    begin_piece(hidden_list());
}

std::vector<VertexEvent>& events_of(Piece& piece, GLenum mode) {
    piece.content = Primitives{mode, {}};
    return std::get<Primitives>(piece.content).events;
}

void forget(GLuint list) {
    const auto found = lists().find(key_of(list));
    if (found == lists().end()) return;
    for (const Piece& piece : found->second)
        if (piece.list >= first_hidden) REAL(glDeleteLists)(piece.list, 1);
    lists().erase(found);
}

void execute(GLuint list, int depth);

struct Execution {
    const Piece& piece;
    int depth;

    void operator()(const LooseEvents& loose) const {
        if (inside_primitives())
            for (const VertexEvent& event : loose.events)
                attribute(event.slot, event.components, event.value[0], event.value[1], event.value[2], event.value[3]);
        REAL(glCallList)(piece.list);
    }
    void operator()(const Primitives& primitives) const {
        if (recorder().wanted()) {
            const Quiet quiet;
            if (auto prepared = prepare_primitives("glBegin in a list"))
                record_primitives(std::move(*prepared), primitives);
        }
        REAL(glCallList)(piece.list);
    }
    void operator()(const ArrayDraws& draws) const {
        if (recorder().wanted()) {
            const Quiet quiet;
            for (const auto& [name, geometry] : draws.draws) {
                auto prepared = prepare_draw(name + " in a list");
                if (!prepared) continue;
                prepared->draw.geometry = geometry;
                std::erase_if(prepared->draw.geometry.arrays, [&](const Array& array) {
                    return std::find(prepared->slots.begin(), prepared->slots.end(), array.slot) ==
                           prepared->slots.end();
                });
                read_current_values(prepared->draw.geometry);
                recorder().draw(prepared->draw);
            }
        }
        REAL(glCallList)(piece.list);
    }
    void operator()(const Calls& calls) const {
        const GLuint base = calls.add_base ? static_cast<GLuint>(integer(GL_LIST_BASE)) : 0;
        for (const GLuint list : calls.lists) execute(base + list, depth + 1);
    }
};

void execute(GLuint list, int depth) {
    const auto found = lists().find(key_of(list));
    if (found == lists().end() || depth > deepest) {
        REAL(glCallList)(list);
        return;
    }
    for (const Piece& piece : found->second) std::visit(Execution{piece, depth}, piece.content);
}

void call(const Calls& calls) {
    const Lock lock;
    if (!compiling) {
        Execution{{}, 0}(calls);
        return;
    }
    REAL(glEndList)();
    compiling->pieces.push_back({0, calls});
    begin_piece(hidden_list());
}

/// Names as glCallLists takes them (OpenGL 2.1, section 5.4).
std::vector<GLuint> names_of(GLsizei count, GLenum type, const void* names) {
    std::vector<GLuint> result;
    const auto* bytes = static_cast<const GLubyte*>(names);
    const auto add = [&]<class T>(T /*kind*/) {
        for (GLsizei i = 0; i < count; ++i) result.push_back(static_cast<GLuint>(static_cast<const T*>(names)[i]));
    };
    const auto add_bytes = [&](std::ptrdiff_t size) {
        for (GLsizei i = 0; i < count; ++i)
            result.push_back(std::accumulate(bytes + i * size, bytes + (i + 1) * size, GLuint{0},
                                             [](GLuint sum, GLubyte byte) { return sum * 256 + byte; }));
    };
    switch (type) {
    case GL_BYTE:
        add(GLbyte{});
        break;
    case GL_UNSIGNED_BYTE:
        add(GLubyte{});
        break;
    case GL_SHORT:
        add(GLshort{});
        break;
    case GL_UNSIGNED_SHORT:
        add(GLushort{});
        break;
    case GL_INT:
        add(GLint{});
        break;
    case GL_UNSIGNED_INT:
        add(GLuint{});
        break;
    case GL_FLOAT:
        add(GLfloat{});
        break;
    case GL_2_BYTES:
        add_bytes(2);
        break;
    case GL_3_BYTES:
        add_bytes(3);
        break;
    case GL_4_BYTES:
        add_bytes(4);
        break;
    default:
        break;
    }
    return result;
}

} // namespace

bool list_is_compiled() { return compiling.has_value(); }

void compile_begin(GLenum mode) {
    next_piece();
    collected_events() = &events_of(compiling->pieces.back(), mode);
    REAL(glBegin)(mode);
}

void compile_end() {
    REAL(glEnd)();
    next_piece();
}

void compile_draws(const std::vector<DrawCall>& calls, const std::function<void()>& perform) {
    std::vector<std::uint32_t> all(slots);
    std::iota(all.begin(), all.end(), 0U);
    ArrayDraws draws;
    {
        const Quiet quiet;
        for (const DrawCall& each : calls)
            if (each.count > 0 && each.instances > 0) draws.draws.emplace_back(each.name, geometry_of(each, all));
    }
    next_piece();
    compiling->pieces.back().content = std::move(draws);
    collected_events() = nullptr;
    perform();
    next_piece();
}

} // namespace record

EXPORTED void glNewList(GLuint list, GLenum mode) {
    const record::Lock lock;
    if (!record::recorder().active() || record::compiling || list == 0) {
        REAL(glNewList)(list, mode);
        return;
    }
    record::forget(list);
    record::compiling.emplace();
    record::compiling->name = list;
    record::compiling->mode = mode;
    record::begin_piece(list);
}

EXPORTED void glEndList() {
    const record::Lock lock;
    REAL(glEndList)();
    if (!record::compiling) return;
    const GLuint name = record::compiling->name;
    const bool executes = record::compiling->mode == GL_COMPILE_AND_EXECUTE;
    record::lists()[record::key_of(name)] = std::move(record::compiling->pieces);
    record::compiling.reset();
    record::collected_events() = nullptr;
    if (executes) record::execute(name, 0);
}

EXPORTED void glCallList(GLuint list) { record::call({{list}, false}); }

EXPORTED void glCallLists(GLsizei count, GLenum type, const void* names) {
    record::call({record::names_of(count, type, names), true});
}

EXPORTED void glDeleteLists(GLuint first, GLsizei count) {
    const record::Lock lock;
    for (GLsizei i = 0; i < count; ++i) record::forget(first + static_cast<GLuint>(i));
    REAL(glDeleteLists)(first, count);
}

std::span<const record::Hook> record::list_hooks() {
    static const std::array hooks{HOOK(glNewList),     HOOK(glEndList),   HOOK(glCallList),  HOOK(glCallLists),
                                  HOOK(glDeleteLists), HOOK(glBegin),     HOOK(glEnd),       HOOK(glMaterialf),
                                  HOOK(glMaterialfv),  HOOK(glMateriali), HOOK(glMaterialiv)};
    return hooks;
}
