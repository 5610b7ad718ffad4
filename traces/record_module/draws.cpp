// The entry points that draw from arrays.
#include "traces/record_module/draws.hpp"

#include "traces/record_module/context.hpp"
#include "traces/record_module/element_types.hpp"
#include "traces/record_module/lists.hpp"
#include "traces/record_module/recorder.hpp"
#include "traces/record_module/state.hpp"
#include "traces/record_module/surfaces.hpp"

#include <algorithm>
#include <cstring>

namespace record {

using namespace record_stream;

bool context_is_usable(const std::string& call) {
    const ContextFacts& context = current_context();
    if (!context.usable) {
        recorder().count(call + " in a context of " + (context.number == 0 ? "nothing" : context.version) +
                         ", where OpenGL 4.5 is needed");
        return false;
    }
    static bool said = false;
    if (!said) recorder().context(context.version, context.renderer);
    said = true;
    return true;
}

namespace {

/// Why a draw cannot be recorded; empty: it can.
std::string obstacle(GLuint program) {
    const bool compatibility = current_context().compatibility;
    if (REAL(glIsEnabled)(GL_RASTERIZER_DISCARD) != GL_FALSE) return "without rasterization";
    if (integer(GL_TRANSFORM_FEEDBACK_ACTIVE) != 0) return "with transform feedback";
    if (compatibility && integer(GL_RENDER_MODE) != GL_RENDER) return "for selection or feedback";
    if (program == 0 && integer(GL_PROGRAM_PIPELINE_BINDING) != 0) return "with a program pipeline";
    if (program == 0 && !compatibility) return "without a program";
    if (program == 0 && (REAL(glIsEnabled)(GL_VERTEX_PROGRAM_ARB) != GL_FALSE ||
                         REAL(glIsEnabled)(GL_FRAGMENT_PROGRAM_ARB) != GL_FALSE))
        return "with an assembly program";
    return {};
}

} // namespace

std::optional<PreparedDraw> prepare_draw(const std::string& call) {
    if (!context_is_usable(call)) return std::nullopt;
    const auto program = static_cast<GLuint>(integer(GL_CURRENT_PROGRAM));
    if (const std::string problem = obstacle(program); !problem.empty()) {
        recorder().count(call + " " + problem);
        draw_targets_changed();
        return std::nullopt;
    }
    PreparedDraw prepared;
    Draw& draw = prepared.draw;
    draw.call = call;
    const KnownProgram* known = nullptr;
    if (program != 0) {
        known = &known_program(program);
        if (!known->problem.empty()) {
            recorder().count(call + " with " + known->problem);
            draw_targets_changed();
            return std::nullopt;
        }
        draw.program = known->number;
        draw.values = values_of(program, *known);
        draw.blocks = blocks_of(program, *known);
        draw.bindings = bindings_of(program, *known);
    } else {
        draw.bindings = fixed_function_bindings();
    }
    draw.targets = draw_targets();
    draw.state = current_state();
    if (current_context().compatibility && (known == nullptr || known->reads_built_in))
        draw.fixed.push_back(current_fixed_function());
    prepared.slots = slots_of(known);
    return prepared;
}

void record_draw(const DrawCall& call) {
    if (call.count <= 0 || call.instances <= 0) return;
    auto prepared = prepare_draw(call.name);
    if (!prepared) return;
    prepared->draw.geometry = geometry_of(call, prepared->slots);
    read_current_values(prepared->draw.geometry);
    recorder().draw(prepared->draw);
}

namespace {

/// Records the draws of a call, then lets the driver do it.
template <class Perform>
void draw(const std::vector<DrawCall>& calls, Perform perform) {
    const Lock lock;
    if (list_is_compiled()) {
        compile_draws(calls, perform);
        return;
    }
    if (recorder().wanted()) {
        const Quiet quiet;
        for (const DrawCall& call : calls) record_draw(call);
    }
    perform();
}

/// Parameters of indirect draws lie in a buffer or, in compatibility profiles, in memory.
template <class Command>
std::vector<Command> commands_at(const void* indirect, GLsizei count, GLsizei stride) {
    std::vector<Command> commands(static_cast<std::size_t>(std::max(count, 0)));
    if (!recorder().wanted()) return {};
    const Quiet quiet;
    const auto buffer = static_cast<GLuint>(integer(GL_DRAW_INDIRECT_BUFFER_BINDING));
    const std::size_t step = stride == 0 ? sizeof(Command) : static_cast<std::size_t>(stride);
    for (std::size_t i = 0; i < commands.size(); ++i) {
        if (buffer != 0) REAL(glGetNamedBufferSubData)
        (buffer, static_cast<GLintptr>(reinterpret_cast<std::uintptr_t>(indirect) + i * step), sizeof(Command),
         &commands[i]);
        else std::memcpy(&commands[i], static_cast<const std::byte*>(indirect) + i * step, sizeof(Command));
    }
    return commands;
}

/// OpenGL 4.5, sections 10.4 and 10.5.
struct ArraysCommand {
    GLuint count, instances, first, base_instance;
};
struct ElementsCommand {
    GLuint count, instances, first_index;
    GLint base_vertex;
    GLuint base_instance;
};

std::vector<DrawCall> indirect_arrays(const char* name, GLenum mode, const void* indirect, GLsizei count,
                                      GLsizei stride) {
    std::vector<DrawCall> calls;
    for (const ArraysCommand& each : commands_at<ArraysCommand>(indirect, count, stride))
        calls.push_back({name, mode, static_cast<GLint>(each.first), static_cast<GLsizei>(each.count), 0, nullptr, 0,
                         static_cast<GLsizei>(each.instances), each.base_instance});
    return calls;
}

std::vector<DrawCall> indirect_elements(const char* name, GLenum mode, GLenum type, const void* indirect, GLsizei count,
                                        GLsizei stride) {
    std::vector<DrawCall> calls;
    for (const ElementsCommand& each : commands_at<ElementsCommand>(indirect, count, stride))
        calls.push_back({name, mode, 0, static_cast<GLsizei>(each.count), type,
                         // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL takes offsets as pointers
                         reinterpret_cast<const void*>(std::size_t{each.first_index} * index_bytes(type)),
                         each.base_vertex, static_cast<GLsizei>(each.instances), each.base_instance});
    return calls;
}

} // namespace

} // namespace record

using record::DrawCall;

EXPORTED void glDrawArrays(GLenum mode, GLint first, GLsizei count) {
    record::draw({{"glDrawArrays", mode, first, count}}, [&] { REAL(glDrawArrays)(mode, first, count); });
}
ALSO_NAMED(glDrawArraysEXT, glDrawArrays);

EXPORTED void glDrawArraysInstanced(GLenum mode, GLint first, GLsizei count, GLsizei instances) {
    record::draw({{"glDrawArraysInstanced", mode, first, count, 0, nullptr, 0, instances}}, [&] {
        REAL(glDrawArraysInstanced)(mode, first, count, instances);
    });
}
ALSO_NAMED(glDrawArraysInstancedARB, glDrawArraysInstanced);
ALSO_NAMED(glDrawArraysInstancedEXT, glDrawArraysInstanced);

EXPORTED void glDrawArraysInstancedBaseInstance(GLenum mode, GLint first, GLsizei count, GLsizei instances,
                                                GLuint base) {
    record::draw({{"glDrawArraysInstancedBaseInstance", mode, first, count, 0, nullptr, 0, instances, base}}, [&] {
        REAL(glDrawArraysInstancedBaseInstance)(mode, first, count, instances, base);
    });
}

EXPORTED void glDrawElements(GLenum mode, GLsizei count, GLenum type, const void* indices) {
    record::draw({{"glDrawElements", mode, 0, count, type, indices}}, [&] {
        REAL(glDrawElements)(mode, count, type, indices);
    });
}

EXPORTED void glDrawRangeElements(GLenum mode, GLuint start, GLuint end, GLsizei count, GLenum type,
                                  const void* indices) {
    record::draw({{"glDrawRangeElements", mode, 0, count, type, indices}}, [&] {
        REAL(glDrawRangeElements)(mode, start, end, count, type, indices);
    });
}
ALSO_NAMED(glDrawRangeElementsEXT, glDrawRangeElements);

EXPORTED void glDrawElementsBaseVertex(GLenum mode, GLsizei count, GLenum type, const void* indices, GLint base) {
    record::draw({{"glDrawElementsBaseVertex", mode, 0, count, type, indices, base}}, [&] {
        REAL(glDrawElementsBaseVertex)(mode, count, type, indices, base);
    });
}

EXPORTED void glDrawRangeElementsBaseVertex(GLenum mode, GLuint start, GLuint end, GLsizei count, GLenum type,
                                            const void* indices, GLint base) {
    record::draw({{"glDrawRangeElementsBaseVertex", mode, 0, count, type, indices, base}}, [&] {
        REAL(glDrawRangeElementsBaseVertex)(mode, start, end, count, type, indices, base);
    });
}

EXPORTED void glDrawElementsInstanced(GLenum mode, GLsizei count, GLenum type, const void* indices, GLsizei instances) {
    record::draw({{"glDrawElementsInstanced", mode, 0, count, type, indices, 0, instances}}, [&] {
        REAL(glDrawElementsInstanced)(mode, count, type, indices, instances);
    });
}
ALSO_NAMED(glDrawElementsInstancedARB, glDrawElementsInstanced);
ALSO_NAMED(glDrawElementsInstancedEXT, glDrawElementsInstanced);

EXPORTED void glDrawElementsInstancedBaseVertex(GLenum mode, GLsizei count, GLenum type, const void* indices,
                                                GLsizei instances, GLint base) {
    record::draw({{"glDrawElementsInstancedBaseVertex", mode, 0, count, type, indices, base, instances}}, [&] {
        REAL(glDrawElementsInstancedBaseVertex)(mode, count, type, indices, instances, base);
    });
}

EXPORTED void glDrawElementsInstancedBaseInstance(GLenum mode, GLsizei count, GLenum type, const void* indices,
                                                  GLsizei instances, GLuint base_instance) {
    record::draw({{"glDrawElementsInstancedBaseInstance", mode, 0, count, type, indices, 0, instances, base_instance}},
                 [&] {
                     REAL(glDrawElementsInstancedBaseInstance)(mode, count, type, indices, instances, base_instance);
                 });
}

EXPORTED void glDrawElementsInstancedBaseVertexBaseInstance(GLenum mode, GLsizei count, GLenum type,
                                                            const void* indices, GLsizei instances, GLint base,
                                                            GLuint base_instance) {
    record::draw({{"glDrawElementsInstancedBaseVertexBaseInstance", mode, 0, count, type, indices, base, instances,
                   base_instance}},
                 [&] {
                     REAL(glDrawElementsInstancedBaseVertexBaseInstance)
                     (mode, count, type, indices, instances, base, base_instance);
                 });
}

EXPORTED void glMultiDrawArrays(GLenum mode, const GLint* first, const GLsizei* count, GLsizei draws) {
    std::vector<DrawCall> calls;
    for (GLsizei i = 0; i < draws; ++i) calls.push_back({"glMultiDrawArrays", mode, first[i], count[i]});
    record::draw(calls, [&] { REAL(glMultiDrawArrays)(mode, first, count, draws); });
}
ALSO_NAMED(glMultiDrawArraysEXT, glMultiDrawArrays);

EXPORTED void glMultiDrawElements(GLenum mode, const GLsizei* count, GLenum type, const void* const* indices,
                                  GLsizei draws) {
    std::vector<DrawCall> calls;
    for (GLsizei i = 0; i < draws; ++i) calls.push_back({"glMultiDrawElements", mode, 0, count[i], type, indices[i]});
    record::draw(calls, [&] { REAL(glMultiDrawElements)(mode, count, type, indices, draws); });
}
ALSO_NAMED(glMultiDrawElementsEXT, glMultiDrawElements);

EXPORTED void glMultiDrawElementsBaseVertex(GLenum mode, const GLsizei* count, GLenum type, const void* const* indices,
                                            GLsizei draws, const GLint* base) {
    std::vector<DrawCall> calls;
    for (GLsizei i = 0; i < draws; ++i)
        calls.push_back({"glMultiDrawElementsBaseVertex", mode, 0, count[i], type, indices[i], base[i]});
    record::draw(calls, [&] { REAL(glMultiDrawElementsBaseVertex)(mode, count, type, indices, draws, base); });
}

EXPORTED void glDrawArraysIndirect(GLenum mode, const void* indirect) {
    record::draw(record::indirect_arrays("glDrawArraysIndirect", mode, indirect, 1, 0), [&] {
        REAL(glDrawArraysIndirect)(mode, indirect);
    });
}

EXPORTED void glDrawElementsIndirect(GLenum mode, GLenum type, const void* indirect) {
    record::draw(record::indirect_elements("glDrawElementsIndirect", mode, type, indirect, 1, 0), [&] {
        REAL(glDrawElementsIndirect)(mode, type, indirect);
    });
}

EXPORTED void glMultiDrawArraysIndirect(GLenum mode, const void* indirect, GLsizei draws, GLsizei stride) {
    record::draw(record::indirect_arrays("glMultiDrawArraysIndirect", mode, indirect, draws, stride), [&] {
        REAL(glMultiDrawArraysIndirect)(mode, indirect, draws, stride);
    });
}

EXPORTED void glMultiDrawElementsIndirect(GLenum mode, GLenum type, const void* indirect, GLsizei draws,
                                          GLsizei stride) {
    record::draw(record::indirect_elements("glMultiDrawElementsIndirect", mode, type, indirect, draws, stride), [&] {
        REAL(glMultiDrawElementsIndirect)(mode, type, indirect, draws, stride);
    });
}

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
