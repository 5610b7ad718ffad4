// Display lists, and vertices between glBegin and glEnd. A list is executed as a whole, so its draws are one call.
#include "tests/replay_oracle/measure_mesa/lists.hpp"

#include "tests/replay_oracle/measure_mesa/positions.hpp"
#include "traces/record_module/context.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

namespace measure {

namespace {

/// A draw of a list, or a list that it calls: by name, or to be added to the list base.
struct Step {
    std::optional<SubmittedDraw> draw{};
    GLuint list = 0;
    bool add_base = false;
};

struct Compiling {
    GLuint name = 0;
    bool executed = false;
    std::vector<Step> steps;
};
std::optional<Compiling> compiling;

std::map<std::pair<std::uint64_t, GLuint>, std::vector<Step>>& lists() { // by context and name
    static auto* const all = new std::map<std::pair<std::uint64_t, GLuint>, std::vector<Step>>;
    return *all;
}
std::pair<std::uint64_t, GLuint> key_of(GLuint list) { return {record::current_context().number, list}; }

constexpr int deepest = 64; ///< GL_MAX_LIST_NESTING is that or more

void add_draws(std::vector<SubmittedDraw>& draws, const std::vector<Step>& steps, int depth) {
    if (depth > deepest) return;
    for (const Step& step : steps) {
        if (step.draw) {
            draws.push_back(*step.draw);
            continue;
        }
        const GLuint base = step.add_base ? static_cast<GLuint>(record::integer(GL_LIST_BASE)) : 0;
        if (const auto found = lists().find(key_of(base + step.list)); found != lists().end())
            add_draws(draws, found->second, depth + 1);
    }
}

/// Between glBegin and glEnd, with the counters outside of lists.
struct Begun {
    SubmittedDraw draw;
    std::optional<Meter> meter;
};
std::optional<Begun> begun;

/// What primitives of a mode are taken apart into.
GLenum simple_primitives(GLenum mode) {
    if (mode == GL_POINTS) return GL_POINTS;
    return mode == GL_LINES || mode == GL_LINE_STRIP || mode == GL_LINE_LOOP ? GL_LINES : GL_TRIANGLES;
}

/// The state that a list changes is put back, as it is executed once more. Matrices only where they changed: what the
/// driver knows of a matrix beside its numbers may be lost.
class KeptState {
  public:
    KeptState() {
        REAL(glPushAttrib)(GL_ALL_ATTRIB_BITS);
        for (std::size_t i = 0; i < stacks.size(); ++i) REAL(glGetFloatv)(stacks[i].second, matrices_[i].data());
    }
    ~KeptState() {
        for (std::size_t i = 0; i < stacks.size(); ++i) {
            Matrix now{};
            REAL(glGetFloatv)(stacks[i].second, now.data());
            if (now == matrices_[i]) continue;
            REAL(glMatrixMode)(stacks[i].first);
            REAL(glLoadMatrixf)(matrices_[i].data());
        }
        REAL(glPopAttrib)();
    }
    KeptState(const KeptState&) = delete;
    KeptState& operator=(const KeptState&) = delete;

  private:
    using Matrix = std::array<float, 16>;
    static constexpr std::array<std::pair<GLenum, GLenum>, 2> stacks{
        {{GL_MODELVIEW, GL_MODELVIEW_MATRIX}, {GL_PROJECTION, GL_PROJECTION_MATRIX}}};
    std::array<Matrix, 2> matrices_{};
};

Positions positions_of_list(const DrawingCall& call, const Counts& counts, const std::function<void()>& perform) {
    const GLenum primitives = simple_primitives(call.draws.front().mode);
    if (std::any_of(call.draws.begin(), call.draws.end(),
                    [primitives](const SubmittedDraw& draw) { return simple_primitives(draw.mode) != primitives; }))
        return {};
    const KeptState kept;
    // The driver may count a quad as one primitive, of two triangles.
    const std::int64_t most = std::max<std::int64_t>({0, counts.vertices * 3, counts.primitives * 6});
    return captured_positions(primitives, static_cast<std::uint64_t>(most), perform);
}

void call_lists(const char* name, const std::vector<Step>& steps, const std::function<void()>& perform) {
    if (compiling) compiling->steps.insert(compiling->steps.end(), steps.begin(), steps.end());
    DrawingCall call{name, {}};
    if (!compiling && !begun && measurement().wanted()) add_draws(call.draws, steps, 0);
    if (call.draws.empty())
        perform();
    else
        measurement().measure(call, perform,
                              [&](const Counts& counts) { return positions_of_list(call, counts, perform); });
}

/// Names as glCallLists takes them (OpenGL 2.1, section 5.4); those of several bytes are not known here.
std::vector<Step> steps_of(GLsizei count, GLenum type, const void* names) {
    std::vector<Step> steps;
    const auto add = [&]<class T>(T /*kind*/) {
        for (GLsizei i = 0; i < count; ++i)
            steps.push_back({{}, static_cast<GLuint>(static_cast<const T*>(names)[i]), true});
    };
    if (type == GL_BYTE) add(GLbyte{});
    if (type == GL_UNSIGNED_BYTE) add(GLubyte{});
    if (type == GL_SHORT) add(GLshort{});
    if (type == GL_UNSIGNED_SHORT) add(GLushort{});
    if (type == GL_INT) add(GLint{});
    if (type == GL_UNSIGNED_INT) add(GLuint{});
    if (type == GL_FLOAT) add(GLfloat{});
    return steps;
}

void count_vertex() {
    if (begun) ++begun->draw.vertices;
}

} // namespace

bool list_is_compiled() { return compiling.has_value(); }

void add_to_list(const std::vector<SubmittedDraw>& draws) {
    for (const SubmittedDraw& draw : draws) compiling->steps.push_back({draw});
}

} // namespace measure

using measure::begun;
using measure::compiling;
using measure::measurement;

EXPORTED void glBegin(GLenum mode) {
    if (compiling || measurement().wanted()) {
        begun.emplace();
        begun->draw = {mode, 0};
        if (!compiling) begun->meter.emplace();
    }
    REAL(glBegin)(mode);
}

EXPORTED void glEnd() {
    REAL(glEnd)();
    if (!begun) return;
    const measure::SubmittedDraw draw = begun->draw;
    if (begun->meter) {
        const measure::Counts counts = begun->meter->stop();
        if (draw.vertices > 0) measurement().add({"glBegin", {draw}}, counts, {});
    } else if (draw.vertices > 0) {
        measure::add_to_list({draw});
    }
    begun.reset();
}

EXPORTED void glNewList(GLuint list, GLenum mode) {
    REAL(glNewList)(list, mode);
    if (!compiling && list != 0) compiling = measure::Compiling{list, mode == GL_COMPILE_AND_EXECUTE, {}};
}

EXPORTED void glEndList() {
    REAL(glEndList)();
    if (!compiling) return;
    const measure::Compiling list = *std::exchange(compiling, std::nullopt);
    measure::lists()[measure::key_of(list.name)] = list.steps;
    if (!list.executed || !measurement().wanted()) return;
    measure::DrawingCall call{"glEndList", {}};
    measure::add_draws(call.draws, list.steps, 0);
    if (!call.draws.empty()) measurement().add(call, {}, {});
}

EXPORTED void glCallList(GLuint list) {
    measure::call_lists("glCallList", {{{}, list, false}}, [&] { REAL(glCallList)(list); });
}

EXPORTED void glCallLists(GLsizei count, GLenum type, const void* names) {
    measure::call_lists("glCallLists", measure::steps_of(count, type, names), [&] {
        REAL(glCallLists)(count, type, names);
    });
}

EXPORTED void glDeleteLists(GLuint first, GLsizei count) {
    for (GLsizei i = 0; i < count; ++i) measure::lists().erase(measure::key_of(first + static_cast<GLuint>(i)));
    REAL(glDeleteLists)(first, count);
}

// A vertex of 2, 3 and 4 numbers, given one by one and in memory.
#define VERTEX(letter, type)                                                                                           \
    EXPORTED void glVertex2##letter(type x, type y) {                                                                  \
        measure::count_vertex();                                                                                       \
        REAL(glVertex2##letter)(x, y);                                                                                 \
    }                                                                                                                  \
    EXPORTED void glVertex3##letter(type x, type y, type z) {                                                          \
        measure::count_vertex();                                                                                       \
        REAL(glVertex3##letter)(x, y, z);                                                                              \
    }                                                                                                                  \
    EXPORTED void glVertex4##letter(type x, type y, type z, type w) {                                                  \
        measure::count_vertex();                                                                                       \
        REAL(glVertex4##letter)(x, y, z, w);                                                                           \
    }                                                                                                                  \
    EXPORTED void glVertex2##letter##v(const type* v) {                                                                \
        measure::count_vertex();                                                                                       \
        REAL(glVertex2##letter##v)(v);                                                                                 \
    }                                                                                                                  \
    EXPORTED void glVertex3##letter##v(const type* v) {                                                                \
        measure::count_vertex();                                                                                       \
        REAL(glVertex3##letter##v)(v);                                                                                 \
    }                                                                                                                  \
    EXPORTED void glVertex4##letter##v(const type* v) {                                                                \
        measure::count_vertex();                                                                                       \
        REAL(glVertex4##letter##v)(v);                                                                                 \
    }
VERTEX(d, GLdouble)
VERTEX(f, GLfloat)
VERTEX(i, GLint)
VERTEX(s, GLshort)
#undef VERTEX

#define VERTEX_HOOKS(letter)                                                                                           \
    HOOK(glVertex2##letter), HOOK(glVertex3##letter), HOOK(glVertex4##letter), HOOK(glVertex2##letter##v),             \
        HOOK(glVertex3##letter##v), HOOK(glVertex4##letter##v)

std::span<const record::Hook> record::vertex_hooks() {
    static const std::array hooks{VERTEX_HOOKS(d), VERTEX_HOOKS(f), VERTEX_HOOKS(i), VERTEX_HOOKS(s)};
    return hooks;
}

std::span<const record::Hook> record::list_hooks() {
    static const std::array hooks{HOOK(glBegin),    HOOK(glEnd),       HOOK(glNewList),    HOOK(glEndList),
                                  HOOK(glCallList), HOOK(glCallLists), HOOK(glDeleteLists)};
    return hooks;
}
