// The entry points that draw from arrays.
#include "tests/replay_oracle/measure_mesa/lists.hpp"
#include "tests/replay_oracle/measure_mesa/positions.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace measure {

namespace {

/// Of all instances of a draw.
std::int64_t vertices_of(GLsizei count, GLsizei instances = 1) {
    return count > 0 && instances > 0 ? std::int64_t{count} * instances : 0;
}

/// Of the draws of a multi-draw, those that draw nothing are left out. `perform` takes the mode, as positions are those
/// of points in place of the primitives: one for each vertex, in their order.
void draw(const char* name, GLenum mode, const std::vector<std::int64_t>& vertices,
          const std::function<void(GLenum)>& perform) {
    DrawingCall call{name, {}};
    std::int64_t known = 0;
    for (const std::int64_t number : vertices) {
        if (number != 0) call.draws.push_back({mode, number});
        known += std::max<std::int64_t>(number, 0);
    }
    if (list_is_compiled()) add_to_list(call.draws);
    if (list_is_compiled() || call.draws.empty() || !measurement().wanted()) {
        perform(mode);
        return;
    }
    measurement().measure(
        call, [&] { perform(mode); },
        [&](const Counts& counts) {
            const auto most = static_cast<std::uint64_t>(std::max(known, counts.vertices));
            return captured_positions(GL_POINTS, most, [&] { perform(GL_POINTS); });
        });
}

std::vector<std::int64_t> vertices_of_all(const GLsizei* counts, GLsizei draws) {
    std::vector<std::int64_t> vertices;
    for (GLsizei i = 0; i < draws; ++i) vertices.push_back(vertices_of(counts[i]));
    return vertices;
}

/// Of draws whose parameters lie in a buffer.
std::vector<std::int64_t> not_known(GLsizei draws) {
    return std::vector<std::int64_t>(static_cast<std::size_t>(std::max(draws, 0)), -1);
}

} // namespace

} // namespace measure

/// A function whose first parameter is `mode`; the arguments call it `as`.
#define DRAW(function, vertices, parameters, arguments)                                                                \
    EXPORTED void function parameters {                                                                                \
        measure::draw(#function, mode, vertices, [&](GLenum as) { REAL(function) arguments; });                        \
    }

DRAW(glDrawArrays, {measure::vertices_of(count)}, (GLenum mode, GLint first, GLsizei count), (as, first, count))
ALSO_NAMED(glDrawArraysEXT, glDrawArrays);
DRAW(glDrawArraysInstanced, {measure::vertices_of(count, instances)},
     (GLenum mode, GLint first, GLsizei count, GLsizei instances), (as, first, count, instances))
ALSO_NAMED(glDrawArraysInstancedARB, glDrawArraysInstanced);
ALSO_NAMED(glDrawArraysInstancedEXT, glDrawArraysInstanced);
DRAW(glDrawArraysInstancedBaseInstance, {measure::vertices_of(count, instances)},
     (GLenum mode, GLint first, GLsizei count, GLsizei instances, GLuint base), (as, first, count, instances, base))
DRAW(glDrawElements, {measure::vertices_of(count)}, (GLenum mode, GLsizei count, GLenum type, const void* indices),
     (as, count, type, indices))
DRAW(glDrawRangeElements, {measure::vertices_of(count)},
     (GLenum mode, GLuint start, GLuint end, GLsizei count, GLenum type, const void* indices),
     (as, start, end, count, type, indices))
ALSO_NAMED(glDrawRangeElementsEXT, glDrawRangeElements);
DRAW(glDrawElementsBaseVertex, {measure::vertices_of(count)},
     (GLenum mode, GLsizei count, GLenum type, const void* indices, GLint base), (as, count, type, indices, base))
DRAW(glDrawRangeElementsBaseVertex, {measure::vertices_of(count)},
     (GLenum mode, GLuint start, GLuint end, GLsizei count, GLenum type, const void* indices, GLint base),
     (as, start, end, count, type, indices, base))
DRAW(glDrawElementsInstanced, {measure::vertices_of(count, instances)},
     (GLenum mode, GLsizei count, GLenum type, const void* indices, GLsizei instances),
     (as, count, type, indices, instances))
ALSO_NAMED(glDrawElementsInstancedARB, glDrawElementsInstanced);
ALSO_NAMED(glDrawElementsInstancedEXT, glDrawElementsInstanced);
DRAW(glDrawElementsInstancedBaseVertex, {measure::vertices_of(count, instances)},
     (GLenum mode, GLsizei count, GLenum type, const void* indices, GLsizei instances, GLint base),
     (as, count, type, indices, instances, base))
DRAW(glDrawElementsInstancedBaseInstance, {measure::vertices_of(count, instances)},
     (GLenum mode, GLsizei count, GLenum type, const void* indices, GLsizei instances, GLuint base_instance),
     (as, count, type, indices, instances, base_instance))
DRAW(glDrawElementsInstancedBaseVertexBaseInstance, {measure::vertices_of(count, instances)},
     (GLenum mode, GLsizei count, GLenum type, const void* indices, GLsizei instances, GLint base,
      GLuint base_instance),
     (as, count, type, indices, instances, base, base_instance))
DRAW(glMultiDrawArrays, measure::vertices_of_all(count, draws),
     (GLenum mode, const GLint* first, const GLsizei* count, GLsizei draws), (as, first, count, draws))
ALSO_NAMED(glMultiDrawArraysEXT, glMultiDrawArrays);
DRAW(glMultiDrawElements, measure::vertices_of_all(count, draws),
     (GLenum mode, const GLsizei* count, GLenum type, const void* const* indices, GLsizei draws),
     (as, count, type, indices, draws))
ALSO_NAMED(glMultiDrawElementsEXT, glMultiDrawElements);
DRAW(glMultiDrawElementsBaseVertex, measure::vertices_of_all(count, draws),
     (GLenum mode, const GLsizei* count, GLenum type, const void* const* indices, GLsizei draws, const GLint* base),
     (as, count, type, indices, draws, base))
DRAW(glDrawArraysIndirect, measure::not_known(1), (GLenum mode, const void* indirect), (as, indirect))
DRAW(glDrawElementsIndirect, measure::not_known(1), (GLenum mode, GLenum type, const void* indirect),
     (as, type, indirect))
DRAW(glMultiDrawArraysIndirect, measure::not_known(draws),
     (GLenum mode, const void* indirect, GLsizei draws, GLsizei stride), (as, indirect, draws, stride))
DRAW(glMultiDrawElementsIndirect, measure::not_known(draws),
     (GLenum mode, GLenum type, const void* indirect, GLsizei draws, GLsizei stride),
     (as, type, indirect, draws, stride))
#undef DRAW

std::span<const record::Hook> record::draw_hooks() {
    static const std::array hooks{
        HOOK(glDrawArrays),
        HOOK(glDrawArraysEXT),
        HOOK(glDrawArraysInstanced),
        HOOK(glDrawArraysInstancedARB),
        HOOK(glDrawArraysInstancedEXT),
        HOOK(glDrawArraysInstancedBaseInstance),
        HOOK(glDrawElements),
        HOOK(glDrawRangeElements),
        HOOK(glDrawRangeElementsEXT),
        HOOK(glDrawElementsBaseVertex),
        HOOK(glDrawRangeElementsBaseVertex),
        HOOK(glDrawElementsInstanced),
        HOOK(glDrawElementsInstancedARB),
        HOOK(glDrawElementsInstancedEXT),
        HOOK(glDrawElementsInstancedBaseVertex),
        HOOK(glDrawElementsInstancedBaseInstance),
        HOOK(glDrawElementsInstancedBaseVertexBaseInstance),
        HOOK(glMultiDrawArrays),
        HOOK(glMultiDrawArraysEXT),
        HOOK(glMultiDrawElements),
        HOOK(glMultiDrawElementsEXT),
        HOOK(glMultiDrawElementsBaseVertex),
        HOOK(glDrawArraysIndirect),
        HOOK(glDrawElementsIndirect),
        HOOK(glMultiDrawArraysIndirect),
        HOOK(glMultiDrawElementsIndirect),
    };
    return hooks;
}
