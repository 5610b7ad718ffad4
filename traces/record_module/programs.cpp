#include "traces/record_module/programs.hpp"

#include "traces/record_module/context.hpp"
#include "traces/record_module/fixed_state_names.hpp"
#include "traces/record_module/recorder.hpp"
#include "traces/record_module/state.hpp"
#include "traces/record_module/surfaces.hpp"
#include "traces/record_module/uniform_types.hpp"

#include <map>

namespace record {

using namespace record_stream;

namespace {

struct Tables {
    /// Sources at the time of linking, when the shaders are still attached; whatever the context, as contexts share
    /// them.
    std::map<GLuint, std::vector<Shader>> linked;
    std::map<GLuint, std::uint64_t> links;
    struct Entry {
        std::uint64_t links = 0;
        KnownProgram program;
    };
    std::map<std::pair<std::uint64_t, GLuint>, Entry> known; ///< by context and name
};
Tables& tables() {
    static auto* const all = new Tables;
    return *all;
}

GLint of_program(GLuint program, GLenum name) {
    GLint value = 0;
    REAL(glGetProgramiv)(program, name, &value);
    return value;
}

std::string source_of(GLuint shader) {
    GLint length = 0;
    REAL(glGetShaderiv)(shader, GL_SHADER_SOURCE_LENGTH, &length);
    std::string source(static_cast<std::size_t>(length), '\0');
    GLsizei written = 0;
    if (length > 0) REAL(glGetShaderSource)(shader, length, &written, source.data());
    source.resize(static_cast<std::size_t>(written));
    return source;
}

void remember_sources(GLuint program) {
    const Lock lock;
    std::array<GLuint, 32> shaders{};
    GLsizei count = 0;
    REAL(glGetAttachedShaders)(program, static_cast<GLsizei>(shaders.size()), &count, shaders.data());
    std::vector<Shader>& sources = tables().linked[program];
    sources.clear();
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        GLint stage = 0;
        REAL(glGetShaderiv)(shaders.at(i), GL_SHADER_TYPE, &stage);
        sources.push_back({static_cast<std::uint32_t>(stage), source_of(shaders.at(i))});
    }
    ++tables().links[program];
}

void forget_sources(GLuint program) {
    const Lock lock;
    tables().linked[program].clear();
    ++tables().links[program];
}

std::string without_index(const std::string& name) {
    return name.ends_with("[0]") ? name.substr(0, name.size() - 3) : name;
}

void list_uniforms(KnownProgram& known, GLuint program) {
    const GLint count = of_program(program, GL_ACTIVE_UNIFORMS);
    std::string name(static_cast<std::size_t>(of_program(program, GL_ACTIVE_UNIFORM_MAX_LENGTH)) + 1, '\0');
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        GLint block = -1, size = 0;
        GLsizei length = 0;
        GLenum type = 0;
        REAL(glGetActiveUniformsiv)(program, 1, &i, GL_UNIFORM_BLOCK_INDEX, &block);
        REAL(glGetActiveUniform)(program, i, static_cast<GLsizei>(name.size()), &length, &size, &type, name.data());
        const std::string whole = name.substr(0, static_cast<std::size_t>(length));
        known.reads_built_in = known.reads_built_in || whole.starts_with("gl_");
        if (block >= 0 || whole.starts_with("gl_")) continue;
        Uniform uniform{without_index(whole), type, {}};
        if (size == 1) {
            uniform.locations.push_back(REAL(glGetUniformLocation)(program, whole.c_str()));
        } else {
            for (GLint element = 0; element < size; ++element)
                uniform.locations.push_back(
                    REAL(glGetUniformLocation)(program, (uniform.name + "[" + std::to_string(element) + "]").c_str()));
        }
        known.uniforms.push_back(uniform);
    }
    const GLint blocks = of_program(program, GL_ACTIVE_UNIFORM_BLOCKS);
    for (GLuint i = 0; i < static_cast<GLuint>(blocks); ++i) {
        std::array<GLchar, 256> text{};
        REAL(glGetActiveUniformBlockName)(program, i, static_cast<GLsizei>(text.size()), nullptr, text.data());
        known.blocks.push_back({text.data(), i});
    }
}

void list_attributes(KnownProgram& known, GLuint program) {
    const GLint count = of_program(program, GL_ACTIVE_ATTRIBUTES);
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        std::array<GLchar, 256> text{};
        GLint size = 0;
        GLenum type = 0;
        REAL(glGetActiveAttrib)
        (program, i, static_cast<GLsizei>(text.size()), nullptr, &size, &type, text.data());
        const std::string name = without_index(text.data());
        known.attributes.push_back({name, type, REAL(glGetAttribLocation)(program, text.data())});
    }
}

std::vector<Variable> outputs_of(GLuint program) {
    std::vector<Variable> outputs;
    GLint count = 0;
    REAL(glGetProgramInterfaceiv)(program, GL_PROGRAM_OUTPUT, GL_ACTIVE_RESOURCES, &count);
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        std::array<GLchar, 256> text{};
        REAL(glGetProgramResourceName)
        (program, GL_PROGRAM_OUTPUT, i, static_cast<GLsizei>(text.size()), nullptr, text.data());
        outputs.push_back({without_index(text.data()), 0, REAL(glGetFragDataLocation)(program, text.data())});
    }
    return outputs;
}

KnownProgram read_program(GLuint program) {
    KnownProgram known;
    Program record;
    record.name = "program " + std::to_string(program);
    record.shaders = tables().linked[program];
    if (record.shaders.empty()) known.problem = "programs without sources";
    for (const Shader& shader : record.shaders) {
        if (shader.source.empty()) known.problem = "shaders without sources";
        if (shader.stage == GL_GEOMETRY_SHADER) known.problem = "geometry shaders";
        if (shader.stage == GL_TESS_CONTROL_SHADER || shader.stage == GL_TESS_EVALUATION_SHADER)
            known.problem = "tessellation shaders";
    }
    if (!known.problem.empty()) return known;
    list_uniforms(known, program);
    list_attributes(known, program);
    record.attributes = known.attributes;
    record.outputs = outputs_of(program);
    known.number = recorder().program(record);
    return known;
}

Value value_of(GLuint program, const Uniform& uniform, const UniformType& type) {
    Value value{uniform.name, uniform.type, {}};
    for (const GLint location : uniform.locations) {
        std::array<std::uint32_t, 16> words{};
        static_assert(sizeof(GLfloat) == 4 && sizeof(GLint) == 4);
        if (location >= 0) {
            if (type.kind == UniformKind::number)
                REAL(glGetUniformfv)(program, location, reinterpret_cast<GLfloat*>(words.data()));
            else
                REAL(glGetUniformiv)(program, location, reinterpret_cast<GLint*>(words.data()));
        }
        for (std::size_t i = 0; i < type.words; ++i)
            value.words.push_back(type.kind == UniformKind::truth ? words.at(i) != 0 : words.at(i));
    }
    return value;
}

/// Of a texture, or of a sampler object in its place.
Sampler sampler_of(GLuint texture, GLuint sampler) {
    const auto whole = [&](GLenum name) {
        GLint value = 0;
        if (sampler != 0)
            REAL(glGetSamplerParameteriv)(sampler, name, &value);
        else
            REAL(glGetTextureParameteriv)(texture, name, &value);
        return static_cast<std::uint32_t>(value);
    };
    const auto number = [&](GLenum name, float* value) {
        if (sampler != 0)
            REAL(glGetSamplerParameterfv)(sampler, name, value);
        else
            REAL(glGetTextureParameterfv)(texture, name, value);
    };
    Sampler result;
    result.wrap = {whole(GL_TEXTURE_WRAP_S), whole(GL_TEXTURE_WRAP_T), whole(GL_TEXTURE_WRAP_R)};
    result.min_filter = whole(GL_TEXTURE_MIN_FILTER);
    result.mag_filter = whole(GL_TEXTURE_MAG_FILTER);
    result.compare_mode = whole(GL_TEXTURE_COMPARE_MODE);
    result.compare_func = whole(GL_TEXTURE_COMPARE_FUNC);
    number(GL_TEXTURE_BORDER_COLOR, result.border.data());
    number(GL_TEXTURE_LOD_BIAS, &result.lod_bias);
    number(GL_TEXTURE_MIN_LOD, &result.least_lod);
    number(GL_TEXTURE_MAX_LOD, &result.most_lod);
    number(GL_TEXTURE_MAX_ANISOTROPY_EXT, &result.anisotropy);
    return result;
}

/// Of the unit that is active.
Binding binding_of(const std::string& variable, std::uint32_t element, GLenum target) {
    Binding binding;
    binding.variable = variable;
    binding.element = element;
    const GLuint texture = bound_texture(target);
    if (texture == 0) return binding;
    binding.surface = sampled_texture(texture, target);
    if (binding.surface < 0) recorder().count("textures without texels");
    if (target == GL_TEXTURE_BUFFER) return binding; // has no parameters
    binding.sampler = sampler_of(texture, static_cast<GLuint>(integer(GL_SAMPLER_BINDING)));
    std::array<GLint, 4> values{};
    REAL(glGetTextureParameteriv)(texture, GL_TEXTURE_SWIZZLE_RGBA, values.data());
    for (std::size_t i = 0; i < 4; ++i) binding.swizzle.at(i) = static_cast<std::uint32_t>(values.at(i));
    const auto ask = [&](GLenum name) {
        GLint value = 0;
        REAL(glGetTextureParameteriv)(texture, name, &value);
        return static_cast<std::uint32_t>(value);
    };
    binding.base_level = ask(GL_TEXTURE_BASE_LEVEL);
    binding.last_level = ask(GL_TEXTURE_MAX_LEVEL);
    if (current_context().compatibility) binding.depth_mode = ask(GL_DEPTH_TEXTURE_MODE);
    return binding;
}

} // namespace

const KnownProgram& known_program(GLuint program) {
    Tables::Entry& entry = tables().known[{current_context().number, program}];
    const std::uint64_t links = tables().links[program];
    if (entry.links != links || (entry.program.number < 0 && entry.program.problem.empty()))
        entry = {links, read_program(program)};
    return entry.program;
}

std::vector<Value> values_of(GLuint program, const KnownProgram& known) {
    std::vector<Value> values;
    for (const Uniform& uniform : known.uniforms) {
        const UniformType type = type_of(uniform.type);
        if (type.kind == UniformKind::sampler) continue;
        if (type.kind == UniformKind::unknown)
            recorder().count("uniforms of other types than 32-bit numbers");
        else
            values.push_back(value_of(program, uniform, type));
    }
    return values;
}

std::vector<Value> blocks_of(GLuint program, const KnownProgram& known) {
    std::vector<Value> values;
    for (const UniformBlock& block : known.blocks) {
        GLint binding = 0, size = 0;
        REAL(glGetActiveUniformBlockiv)(program, block.index, GL_UNIFORM_BLOCK_BINDING, &binding);
        REAL(glGetActiveUniformBlockiv)(program, block.index, GL_UNIFORM_BLOCK_DATA_SIZE, &size);
        const auto at = static_cast<GLuint>(binding);
        const auto buffer = static_cast<GLuint>(integer_at(GL_UNIFORM_BUFFER_BINDING, at));
        GLint64 start = 0, room = 0;
        REAL(glGetInteger64i_v)(GL_UNIFORM_BUFFER_START, at, &start);
        Value value{block.name, 0, std::vector<std::uint32_t>(static_cast<std::size_t>(size + 3) / 4)};
        if (buffer != 0) REAL(glGetNamedBufferParameteri64v)(buffer, GL_BUFFER_SIZE, &room);
        const GLint64 bytes = std::min<GLint64>(size, room - start);
        if (bytes > 0) REAL(glGetNamedBufferSubData)(buffer, start, bytes, value.words.data());
        values.push_back(std::move(value));
    }
    return values;
}

std::vector<Binding> bindings_of(GLuint program, const KnownProgram& known) {
    std::vector<Binding> bindings;
    const GLint active = integer(GL_ACTIVE_TEXTURE);
    for (const Uniform& uniform : known.uniforms) {
        const UniformType type = type_of(uniform.type);
        if (type.kind != UniformKind::sampler) continue;
        for (std::uint32_t element = 0; element < uniform.locations.size(); ++element) {
            GLint unit = 0;
            if (uniform.locations[element] < 0) continue;
            REAL(glGetUniformiv)(program, uniform.locations[element], &unit);
            REAL(glActiveTexture)(GL_TEXTURE0 + static_cast<GLenum>(unit));
            bindings.push_back(binding_of(uniform.name, element, type.target));
        }
    }
    REAL(glActiveTexture)(static_cast<GLenum>(active));
    return bindings;
}

std::vector<Binding> fixed_function_bindings() {
    std::vector<Binding> bindings;
    const GLint active = integer(GL_ACTIVE_TEXTURE);
    for (std::uint32_t unit = 0; unit < texture_units; ++unit)
        if (const GLenum target = enabled_target(unit); target != 0) bindings.push_back(binding_of("", unit, target));
    REAL(glActiveTexture)(static_cast<GLenum>(active));
    return bindings;
}

} // namespace record

EXPORTED void glLinkProgram(GLuint program) {
    record::remember_sources(program);
    REAL(glLinkProgram)(program);
}
EXPORTED void glLinkProgramARB(GLhandleARB program) {
    record::remember_sources(static_cast<GLuint>(program)); // Mesa's handles are names
    REAL(glLinkProgramARB)(program);
}
EXPORTED void glProgramBinary(GLuint program, GLenum format, const void* binary, GLsizei length) {
    record::forget_sources(program);
    REAL(glProgramBinary)(program, format, binary, length);
}
EXPORTED void glShaderBinary(GLsizei count, const GLuint* shaders, GLenum format, const void* binary, GLsizei length) {
    record::recorder().count("glShaderBinary");
    REAL(glShaderBinary)(count, shaders, format, binary, length);
}

std::span<const record::Hook> record::program_hooks() {
    static const std::array hooks{HOOK(glLinkProgram), HOOK(glLinkProgramARB), HOOK(glProgramBinary),
                                  HOOK(glShaderBinary)};
    return hooks;
}
