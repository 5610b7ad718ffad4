#include "tests/support/mesa_shaders.hpp"

#include "tests/oracle/mesa_context.hpp"
#include "tests/oracle/mesa_texture_upload.hpp"
#include "tests/support/oracle_textures.hpp"

#if ROPSIM_HAVE_EGL

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <fmt/format.h>
#include <stdexcept>

namespace tests {

namespace {

// Of the compatibility profile.
constexpr GLenum clamp_vertex_color = 0x891A, clamp_fragment_color = 0x891B;

std::string linear_vertex_source(const std::string& version, const std::vector<LinearInput>& inputs) {
    const bool modern = version.find("#version") != std::string::npos && version.find("110") == std::string::npos &&
                        version.find("120") == std::string::npos;
    std::string declarations, statements;
    for (const LinearInput& input : inputs) {
        const auto vector = [&](const std::array<float, 4>& v) {
            constexpr std::array<const char*, 4> types{"float", "vec2", "vec3", "vec4"};
            std::string text = fmt::format("{}(", types.at(input.components - 1));
            for (std::uint32_t i = 0; i < input.components; ++i)
                text += fmt::format("{}{:#}", i == 0 ? "" : ", ", v[i]);
            return text + ")";
        };
        if (!input.declaration.empty())
            declarations += fmt::format("{} {} {};\n", input.qualifier, modern ? "out" : "varying", input.declaration);
        statements += fmt::format("    {} = {}({} + {} * corner.x + {} * corner.y);\n",
                                  input.name == "gl_Color" ? "gl_FrontColor" : input.name, input.type,
                                  vector(input.base), vector(input.right), vector(input.up));
    }
    return fmt::format("{}\n{} vec2 corner;\n{}void main() {{\n    gl_Position = vec4(corner, 0.0, 1.0);\n{}}}\n",
                       version, modern ? "in" : "attribute", declarations, statements);
}

/// What OpenGL's enumeration says of a uniform's type.
struct GlType {
    GLenum type;
    std::uint32_t components, columns;
    bool real;
};
constexpr std::array<GlType, 25> gl_types{{
    {GL_FLOAT, 1, 1, true},
    {GL_FLOAT_VEC2, 2, 1, true},
    {GL_FLOAT_VEC3, 3, 1, true},
    {GL_FLOAT_VEC4, 4, 1, true},
    {GL_INT, 1, 1, false},
    {GL_INT_VEC2, 2, 1, false},
    {GL_INT_VEC3, 3, 1, false},
    {GL_INT_VEC4, 4, 1, false},
    {GL_BOOL, 1, 1, false},
    {GL_BOOL_VEC2, 2, 1, false},
    {GL_BOOL_VEC3, 3, 1, false},
    {GL_BOOL_VEC4, 4, 1, false},
    {GL_FLOAT_MAT2, 2, 2, true},
    {GL_FLOAT_MAT3, 3, 3, true},
    {GL_FLOAT_MAT4, 4, 4, true},
    {GL_FLOAT_MAT2x3, 3, 2, true},
    {GL_FLOAT_MAT2x4, 4, 2, true},
    {GL_FLOAT_MAT3x2, 2, 3, true},
    {GL_FLOAT_MAT3x4, 4, 3, true},
    {GL_FLOAT_MAT4x2, 2, 4, true},
    {GL_FLOAT_MAT4x3, 3, 4, true},
    {GL_UNSIGNED_INT, 1, 1, false},
    {GL_UNSIGNED_INT_VEC2, 2, 1, false},
    {GL_UNSIGNED_INT_VEC3, 3, 1, false},
    {GL_UNSIGNED_INT_VEC4, 4, 1, false},
}};

struct SamplerType {
    GLenum type, target;
};
constexpr std::array<SamplerType, 10> samplers{{{GL_SAMPLER_1D, GL_TEXTURE_1D},
                                                {GL_SAMPLER_2D, GL_TEXTURE_2D},
                                                {GL_SAMPLER_3D, GL_TEXTURE_3D},
                                                {GL_SAMPLER_CUBE, GL_TEXTURE_CUBE_MAP},
                                                {GL_SAMPLER_2D_ARRAY, GL_TEXTURE_2D_ARRAY},
                                                {GL_SAMPLER_2D_RECT, GL_TEXTURE_RECTANGLE},
                                                {GL_SAMPLER_BUFFER, GL_TEXTURE_BUFFER},
                                                {GL_SAMPLER_2D_SHADOW, GL_TEXTURE_2D},
                                                {GL_SAMPLER_CUBE_SHADOW, GL_TEXTURE_CUBE_MAP},
                                                {GL_UNSIGNED_INT_SAMPLER_2D, GL_TEXTURE_2D}}};

class LlvmpipeShaders : public MesaShaders {
  public:
    explicit LlvmpipeShaders(const MesaContext& context) : context_(context) {
        const CurrentMesaContext current(context_);
        constexpr std::array<float, 6> corners{-1, -1, 3, -1, -1, 3};
        glGenBuffers(1, &corners_);
        glBindBuffer(GL_ARRAY_BUFFER, corners_);
        glBufferData(GL_ARRAY_BUFFER, sizeof corners, corners.data(), GL_STATIC_DRAW);
        glGenVertexArrays(1, &vertex_array_);
        glBindVertexArray(vertex_array_);
        glEnableVertexAttribArray(0);
        glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
        glGenFramebuffers(1, &framebuffer_);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        glGenRenderbuffers(1, &colour_);
        glBindRenderbuffer(GL_RENDERBUFFER, colour_);
        glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, size, size);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
        glClampColor(GL_CLAMP_READ_COLOR, GL_FALSE);
        glClampColor(clamp_fragment_color, GL_FALSE);
        glClampColor(clamp_vertex_color, GL_FALSE);
    }

    ShaderPicture draw(const std::string& fragment_source, const std::string& version,
                       const std::vector<LinearInput>& inputs,
                       const std::function<float(const ActiveUniform&, std::uint32_t)>& value,
                       const std::function<float(const ActiveBlock&, std::uint32_t)>& block,
                       const std::function<std::uint32_t(const ActiveUniform&)>& unit) override {
        const CurrentMesaContext current(context_);
        const GLuint program = link_program(linear_vertex_source(version, inputs), fragment_source, {"corner"});
        glUseProgram(program);
        std::vector<GLuint> textures, buffers;
        set_uniforms(program, value, unit, textures, buffers);
        set_blocks(program, block, buffers);
        ShaderPicture picture = render();
        glUseProgram(0);
        glDeleteProgram(program);
        glDeleteTextures(static_cast<GLsizei>(textures.size()), textures.data());
        glDeleteBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
        if (glGetError() != GL_NO_ERROR) throw std::runtime_error("the OpenGL reference reports an error");
        return picture;
    }

    void set_texture(const MesaTexture* texture) override { texture_ = texture; }

    std::vector<std::array<std::uint8_t, 4>> decoded(const MesaTexture& texture) override {
        const CurrentMesaContext current(context_);
        const GLuint name = upload_texture(GL_TEXTURE_2D, texture);
        std::vector<std::array<std::uint8_t, 4>> texels(std::size_t{texture.surface.width} * texture.surface.height);
        glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
        glDeleteTextures(1, &name);
        if (glGetError() != GL_NO_ERROR) throw std::runtime_error("the OpenGL reference reports an error");
        return texels;
    }

  private:
    ShaderPicture render() const {
        ShaderPicture picture;
        picture.colour.resize(std::size_t{size} * size);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        glBindVertexArray(vertex_array_);
        glViewport(0, 0, size, size);
        const std::array<float, 4> background{untouched, untouched, untouched, untouched};
        glClearBufferfv(GL_COLOR, 0, background.data());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glReadPixels(0, 0, size, size, GL_RGBA, GL_FLOAT, picture.colour.data());
        return picture;
    }

    void set_uniforms(GLuint program, const std::function<float(const ActiveUniform&, std::uint32_t)>& value,
                      const std::function<std::uint32_t(const ActiveUniform&)>& unit, std::vector<GLuint>& textures,
                      std::vector<GLuint>& buffers) const {
        GLint count = 0;
        glGetProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
        for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
            std::array<char, 200> name{};
            GLint elements = 0;
            GLenum type = 0;
            glGetActiveUniform(program, i, static_cast<GLsizei>(name.size()), nullptr, &elements, &type, name.data());
            const GLint location = glGetUniformLocation(program, name.data());
            if (location < 0) continue; // in a block, or built in
            ActiveUniform uniform;
            uniform.name = name.data();
            if (uniform.name.ends_with("[0]")) uniform.name.resize(uniform.name.size() - 3);
            uniform.elements = static_cast<std::uint32_t>(elements);
            bool known = false;
            for (const SamplerType& sampler : samplers)
                if (sampler.type == type) {
                    uniform.sampler = known = true;
                    bind_texture(sampler, location, uniform.elements, unit(uniform), textures, buffers);
                }
            for (const GlType& of : gl_types)
                if (of.type == type) {
                    known = true;
                    uniform.components = of.components;
                    uniform.columns = of.columns;
                    uniform.real = of.real;
                    set_value(type, location, uniform, value);
                }
            if (!known) throw std::runtime_error("a uniform of a type that the harness does not know: " + uniform.name);
        }
    }

    static void set_value(GLenum type, GLint location, const ActiveUniform& uniform,
                          const std::function<float(const ActiveUniform&, std::uint32_t)>& value) {
        const std::uint32_t scalars = uniform.components * uniform.columns;
        for (std::uint32_t element = 0; element < uniform.elements; ++element) {
            std::array<float, 16> reals{};
            std::array<GLint, 4> whole{};
            std::array<GLuint, 4> natural{};
            for (std::uint32_t i = 0; i < scalars; ++i) {
                reals[i] = value(uniform, element * scalars + i);
                if (!uniform.real) whole[i] = static_cast<GLint>(reals[i]), natural[i] = static_cast<GLuint>(reals[i]);
            }
            const GLint at = location + static_cast<GLint>(element);
            const bool is_natural = type == GL_UNSIGNED_INT || type == GL_UNSIGNED_INT_VEC2 ||
                                    type == GL_UNSIGNED_INT_VEC3 || type == GL_UNSIGNED_INT_VEC4;
            if (is_natural) {
                constexpr std::array set{glUniform1uiv, glUniform2uiv, glUniform3uiv, glUniform4uiv};
                set[uniform.components - 1](at, 1, natural.data());
            } else if (!uniform.real) {
                constexpr std::array set{glUniform1iv, glUniform2iv, glUniform3iv, glUniform4iv};
                set[uniform.components - 1](at, 1, whole.data());
            } else if (uniform.columns == 1) {
                constexpr std::array set{glUniform1fv, glUniform2fv, glUniform3fv, glUniform4fv};
                set[uniform.components - 1](at, 1, reals.data());
            } else {
                constexpr std::array set{glUniformMatrix2fv,   glUniformMatrix2x3fv, glUniformMatrix2x4fv,
                                         glUniformMatrix3x2fv, glUniformMatrix3fv,   glUniformMatrix3x4fv,
                                         glUniformMatrix4x2fv, glUniformMatrix4x3fv, glUniformMatrix4fv};
                set[(uniform.columns - 2) * 3 + uniform.components - 2](at, 1, GL_FALSE, reals.data());
            }
        }
    }

    void bind_texture(const SamplerType& sampler, GLint location, std::uint32_t elements, std::uint32_t unit,
                      std::vector<GLuint>& textures, std::vector<GLuint>& buffers) const {
        constexpr GLsizei n = oracle_texture_size;
        std::vector<std::array<float, 4>> texels(std::size_t{n} * n * n);
        for (std::uint32_t i = 0; i < texels.size(); ++i)
            for (std::uint32_t c = 0; c < 4; ++c) texels[i][c] = oracle_texel(unit, i % n, i / n % n, i / (n * n), c);
        const std::vector<GLint> units(elements, static_cast<GLint>(unit)); // one texture for all of an array
        glUniform1iv(location, static_cast<GLsizei>(elements), units.data());
        glActiveTexture(GL_TEXTURE0 + unit);
        if (texture_ != nullptr) {
            textures.push_back(upload_texture(sampler.target, *texture_));
            return;
        }
        textures.push_back(0);
        glGenTextures(1, &textures.back());
        const GLenum target = sampler.target;
        glBindTexture(target, textures.back());
        const auto* data = texels.data();
        if (target == GL_TEXTURE_BUFFER) {
            buffers.push_back(0);
            glGenBuffers(1, &buffers.back());
            glBindBuffer(GL_TEXTURE_BUFFER, buffers.back());
            glBufferData(GL_TEXTURE_BUFFER, n * 16, data, GL_STATIC_DRAW);
            glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, buffers.back());
            return;
        }
        std::vector<float> depths;
        for (std::size_t i = 0; i < std::size_t{n} * n; ++i) depths.push_back(texels[i][0]);
        if (sampler.type == GL_SAMPLER_2D_SHADOW) {
            glTexImage2D(target, 0, GL_DEPTH_COMPONENT32F, n, n, 0, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
            glTexParameteri(target, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
            glTexParameteri(target, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
        } else if (target == GL_TEXTURE_1D) {
            glTexImage1D(target, 0, GL_RGBA32F, n, 0, GL_RGBA, GL_FLOAT, data);
        } else if (target == GL_TEXTURE_3D || target == GL_TEXTURE_2D_ARRAY) {
            glTexImage3D(target, 0, GL_RGBA32F, n, n, n, 0, GL_RGBA, GL_FLOAT, data);
        } else if (target == GL_TEXTURE_CUBE_MAP) {
            for (GLenum face = 0; face < 6; ++face)
                glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_RGBA32F, n, n, 0, GL_RGBA, GL_FLOAT,
                             data + face * n * n);
        } else {
            glTexImage2D(target, 0, GL_RGBA32F, n, n, 0, GL_RGBA, GL_FLOAT, data);
        }
        const GLint wrap =
            target == GL_TEXTURE_RECTANGLE || target == GL_TEXTURE_CUBE_MAP ? GL_CLAMP_TO_EDGE : GL_REPEAT;
        for (const GLenum which : {GLenum{GL_TEXTURE_WRAP_S}, GLenum{GL_TEXTURE_WRAP_T}, GLenum{GL_TEXTURE_WRAP_R}})
            glTexParameteri(target, which, wrap);
        glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }

    static void set_blocks(GLuint program, const std::function<float(const ActiveBlock&, std::uint32_t)>& value,
                           std::vector<GLuint>& buffers) {
        GLint count = 0;
        glGetProgramiv(program, GL_ACTIVE_UNIFORM_BLOCKS, &count);
        for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
            std::array<char, 200> name{};
            GLint bytes = 0;
            glGetActiveUniformBlockName(program, i, static_cast<GLsizei>(name.size()), nullptr, name.data());
            glGetActiveUniformBlockiv(program, i, GL_UNIFORM_BLOCK_DATA_SIZE, &bytes);
            const ActiveBlock block{name.data(), static_cast<std::uint32_t>(bytes)};
            std::vector<float> words(block.bytes / 4);
            for (std::uint32_t word = 0; word < words.size(); ++word) words[word] = value(block, word);
            buffers.push_back(0);
            glGenBuffers(1, &buffers.back());
            glBindBuffer(GL_UNIFORM_BUFFER, buffers.back());
            glBufferData(GL_UNIFORM_BUFFER, bytes, words.data(), GL_STATIC_DRAW);
            glUniformBlockBinding(program, i, i);
            glBindBufferBase(GL_UNIFORM_BUFFER, i, buffers.back());
        }
    }

    MesaContext context_;
    GLuint corners_ = 0, vertex_array_ = 0, framebuffer_ = 0, colour_ = 0;
    const MesaTexture* texture_ = nullptr;
};

} // namespace

std::unique_ptr<MesaShaders> MesaShaders::create(std::string& reason) {
    // The compatibility profile: shaders of GLSL 1.10 and 4.50 in one context.
    const auto context = create_mesa_context(MesaProfile::compatibility, reason);
    return context ? std::make_unique<LlvmpipeShaders>(*context) : nullptr;
}

} // namespace tests

#else

namespace tests {

std::unique_ptr<MesaShaders> MesaShaders::create(std::string& reason) {
    reason = "built without EGL (package libegl-dev)";
    return nullptr;
}

} // namespace tests

#endif
