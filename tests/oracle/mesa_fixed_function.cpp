#include "tests/support/mesa_fixed_function.hpp"

#include "tests/oracle/mesa_context.hpp"
#include "tests/oracle/mesa_fixed_function_state.hpp"

#if ROPSIM_HAVE_EGL

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <array>
#include <cstring>
#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>
#include <stdexcept>

namespace tests {

namespace {

using namespace traces;

constexpr GLsizei texels = 16; ///< along each side of a texture

class Textures {
  public:
    explicit Textures(const FixedFunctionState& state) {
        for (std::uint32_t unit = 0; unit < fixed_function_units; ++unit) {
            const FixedTextureUnit& from = state.units[unit];
            if (from.target == UnitTarget::none) continue;
            glActiveTexture(GL_TEXTURE0 + unit);
            make(from, unit, texture_target(from.target));
            // Shaders see the one row of a plane instead of a line.
            if (from.target == UnitTarget::one_dimensional) make(from, unit, GL_TEXTURE_2D);
        }
    }
    ~Textures() { glDeleteTextures(static_cast<GLsizei>(names_.size()), names_.data()); }
    Textures(const Textures&) = delete;
    Textures& operator=(const Textures&) = delete;

  private:
    void make(const FixedTextureUnit& from, std::uint32_t unit, GLenum target) {
        names_.push_back(0);
        glGenTextures(1, &names_.back());
        glBindTexture(target, names_.back());
        constexpr std::array<GLint, 8> formats{
            GL_ALPHA8, GL_LUMINANCE8, GL_LUMINANCE8_ALPHA8, GL_INTENSITY8, GL_R8, GL_RG8, GL_RGB8, GL_RGBA8};
        const GLint format = from.compares ? static_cast<GLint>(GL_DEPTH_COMPONENT24)
                                           : formats.at(static_cast<std::size_t>(from.format));
        const GLenum data_format = from.compares ? GL_DEPTH_COMPONENT : GL_RGBA;
        std::vector<std::uint8_t> data(std::size_t{6} * 4 * texels * texels * texels);
        sim::Random random(unit, "texels");
        for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(random.below(256));
        const GLsizei rows = from.target == UnitTarget::one_dimensional ? 1 : texels;
        if (target == GL_TEXTURE_1D)
            glTexImage1D(target, 0, format, texels, 0, data_format, GL_UNSIGNED_BYTE, data.data());
        else if (target == GL_TEXTURE_3D)
            glTexImage3D(target, 0, format, texels, texels, texels, 0, data_format, GL_UNSIGNED_BYTE, data.data());
        else if (target == GL_TEXTURE_CUBE_MAP)
            for (GLenum face = 0; face < 6; ++face)
                glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, format, texels, texels, 0, data_format,
                             GL_UNSIGNED_BYTE, data.data() + std::size_t{face} * 4 * texels * texels);
        else
            glTexImage2D(target, 0, format, texels, rows, 0, data_format, GL_UNSIGNED_BYTE, data.data());
        const GLint wrap =
            target == GL_TEXTURE_RECTANGLE || target == GL_TEXTURE_CUBE_MAP ? GL_CLAMP_TO_EDGE : GL_REPEAT;
        for (const GLenum which : {GLenum{GL_TEXTURE_WRAP_S}, GLenum{GL_TEXTURE_WRAP_T}, GLenum{GL_TEXTURE_WRAP_R}})
            glTexParameteri(target, which, wrap);
        glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        if (!from.compares) return;
        glTexParameteri(target, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_R_TO_TEXTURE);
        glTexParameteri(target, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
        glTexParameteri(target, GL_DEPTH_TEXTURE_MODE,
                        from.format == BaseFormat::alpha       ? GL_ALPHA
                        : from.format == BaseFormat::intensity ? GL_INTENSITY
                                                               : GL_LUMINANCE);
    }

    std::vector<GLuint> names_;
};

/// Linked, with inputs at the places that they have in `from.inputs`.
GLuint program_of(const FixedFunctionProgram& from) {
    std::vector<std::string> inputs;
    for (const auto& input : from.inputs) inputs.push_back(input.variable);
    return link_program(from.vertex, from.fragment, inputs);
}

const std::vector<std::uint32_t>* words_of(const FixedFunctionProgram& program, const std::string& name) {
    for (const auto* values : {&program.vertex_values, &program.fragment_values})
        for (const UniformValue& value : *values)
            if (value.name == name) return &value.words;
    return nullptr;
}

void set_uniforms(GLuint name, const FixedFunctionProgram& program) {
    for (const std::uint32_t unit : program.units)
        glUniform1i(glGetUniformLocation(name, fmt::format("texture{}", unit).c_str()), static_cast<GLint>(unit));
    GLint count = 0;
    glGetProgramiv(name, GL_ACTIVE_UNIFORMS, &count);
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        std::array<char, 100> uniform{};
        GLint elements = 0;
        GLenum type = 0;
        glGetActiveUniform(name, i, static_cast<GLsizei>(uniform.size()), nullptr, &elements, &type, uniform.data());
        const GLint location = glGetUniformLocation(name, uniform.data());
        const std::vector<std::uint32_t>* words = words_of(program, uniform.data());
        if (words == nullptr) {
            if (std::string(uniform.data()).starts_with("texture") && type != GL_FLOAT_MAT4) continue;
            throw std::runtime_error(fmt::format("no value of uniform {}", uniform.data()));
        }
        std::vector<float> values(words->size());
        std::memcpy(values.data(), words->data(), words->size() * sizeof(float));
        if (type == GL_FLOAT_MAT4)
            glUniformMatrix4fv(location, 1, GL_FALSE, values.data());
        else if (type == GL_FLOAT_MAT3)
            glUniformMatrix3fv(location, 1, GL_FALSE, values.data());
        else if (type == GL_FLOAT_VEC4)
            glUniform4fv(location, 1, values.data());
        else if (type == GL_FLOAT_VEC3)
            glUniform3fv(location, 1, values.data());
        else
            glUniform1fv(location, 1, values.data());
    }
}

struct Array {
    GLint components;
    const float* values;
};

Array array_of(const FixedFunctionMesh& mesh, const std::string& input) {
    if (input == "position") return {4, glm::value_ptr(mesh.positions.front())};
    if (input == "normal") return {3, glm::value_ptr(mesh.normals.front())};
    if (input == "colour") return {4, glm::value_ptr(mesh.colours.front())};
    if (input == "secondary_colour") return {3, glm::value_ptr(mesh.secondary_colours.front())};
    if (input == "fog_coordinate") return {1, mesh.fog_coordinates.data()};
    const auto unit = static_cast<std::size_t>(input.back() - '0');
    return {4, glm::value_ptr(mesh.texcoords.at(unit).front())};
}

void set_arrays(const FixedFunctionMesh& mesh) {
    for (const GLenum array : {GLenum{GL_VERTEX_ARRAY}, GLenum{GL_NORMAL_ARRAY}, GLenum{GL_COLOR_ARRAY},
                               GLenum{GL_SECONDARY_COLOR_ARRAY}, GLenum{GL_FOG_COORDINATE_ARRAY}})
        glEnableClientState(array);
    glVertexPointer(4, GL_FLOAT, 0, mesh.positions.data());
    glNormalPointer(GL_FLOAT, 0, mesh.normals.data());
    glColorPointer(4, GL_FLOAT, 0, mesh.colours.data());
    glSecondaryColorPointer(3, GL_FLOAT, 0, mesh.secondary_colours.data());
    glFogCoordPointer(GL_FLOAT, 0, mesh.fog_coordinates.data());
    for (std::uint32_t unit = 0; unit < fixed_function_units; ++unit) {
        glClientActiveTexture(GL_TEXTURE0 + unit);
        glEnableClientState(GL_TEXTURE_COORD_ARRAY);
        glTexCoordPointer(4, GL_FLOAT, 0, mesh.texcoords[unit].data());
    }
}

class LlvmpipeFixedFunction : public MesaFixedFunction {
  public:
    explicit LlvmpipeFixedFunction(const MesaContext& context) : context_(context) {
        const Current current(context_);
        glGenFramebuffers(1, &framebuffer_);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        glGenRenderbuffers(1, &colour_);
        glBindRenderbuffer(GL_RENDERBUFFER, colour_);
        glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, size, size);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
    }

    std::vector<glm::u8vec4> draw(const FixedFunctionState& state, const FixedFunctionMesh& mesh) override {
        const Current current(context_);
        const Textures textures(state);
        set_fixed_function(state);
        set_arrays(mesh);
        return picture(state, mesh);
    }

    std::vector<glm::u8vec4> draw(const FixedFunctionState& state, const FixedFunctionProgram& program,
                                  const FixedFunctionMesh& mesh) override {
        const Current current(context_);
        const Textures textures(state);
        set_around_shaders(state);
        if (program.sizes_points) glEnable(GL_PROGRAM_POINT_SIZE);
        const GLuint name = program_of(program);
        glUseProgram(name);
        set_uniforms(name, program);
        for (GLuint i = 0; i < program.inputs.size(); ++i) {
            const Array array = array_of(mesh, program.inputs[i].variable);
            glEnableVertexAttribArray(i);
            glVertexAttribPointer(i, array.components, GL_FLOAT, GL_FALSE, 0, array.values);
        }
        std::vector<glm::u8vec4> result = picture(state, mesh);
        glUseProgram(0);
        glDeleteProgram(name);
        return result;
    }

  private:
    /// The context, with all of its state as it was afterwards; and then the one that was current.
    class Current {
      public:
        explicit Current(const MesaContext& context) : current_(context) {
            glPushAttrib(GL_ALL_ATTRIB_BITS);
            glPushClientAttrib(GL_CLIENT_ALL_ATTRIB_BITS);
        }
        ~Current() {
            glPopClientAttrib();
            glPopAttrib();
        }
        Current(const Current&) = delete;
        Current& operator=(const Current&) = delete;

      private:
        CurrentMesaContext current_;
    };

    std::vector<glm::u8vec4> picture(const FixedFunctionState& state, const FixedFunctionMesh& mesh) const {
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        glViewport(0, 0, size, size);
        glDisable(GL_DITHER);
        glClearColor(0.2F, 0.4F, 0.6F, 0.8F);
        glClear(GL_COLOR_BUFFER_BIT);
        if (state.points.drawn)
            glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(mesh.positions.size()));
        else
            glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh.indices.size()), GL_UNSIGNED_INT,
                           mesh.indices.data());
        std::vector<glm::u8vec4> pixels(std::size_t{size} * size);
        glReadPixels(0, 0, size, size, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        if (const GLenum error = glGetError(); error != GL_NO_ERROR)
            throw std::runtime_error(fmt::format("the OpenGL reference reports error {:x}", error));
        return pixels;
    }

    MesaContext context_;
    GLuint framebuffer_ = 0, colour_ = 0;
};

} // namespace

std::unique_ptr<MesaFixedFunction> MesaFixedFunction::create(std::string& reason) {
    const auto context = create_mesa_context(MesaProfile::compatibility, reason);
    return context ? std::make_unique<LlvmpipeFixedFunction>(*context) : nullptr;
}

} // namespace tests

#else

namespace tests {

std::unique_ptr<MesaFixedFunction> MesaFixedFunction::create(std::string& reason) {
    reason = "built without EGL (package libegl-dev)";
    return nullptr;
}

} // namespace tests

#endif
