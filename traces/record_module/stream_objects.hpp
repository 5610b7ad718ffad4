// What draws name: contents, surfaces, programs. See stream.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace record_stream {

inline constexpr std::uint32_t version = 1;

/// Of the first context in which something was recorded.
struct Context {
    std::uint32_t stream_version = version;
    std::string gl_version, renderer;

    void fields(auto& archive) { archive(stream_version, gl_version, renderer); }
};

struct Blob {
    std::vector<std::byte> bytes;

    void fields(auto& archive) { archive(bytes); }
};

struct SurfaceLevel {
    std::uint32_t width = 0, height = 0, depth = 0;
    std::int32_t blob = -1;

    void fields(auto& archive) { archive(width, height, depth, blob); }
};

enum Bits : std::size_t {
    bits_red,
    bits_green,
    bits_blue,
    bits_alpha,
    bits_luminance,
    bits_intensity,
    bits_depth,
    bits_stencil,
    bits_kinds
};

struct Surface {
    std::string name;
    std::uint32_t target = 0; ///< GL_TEXTURE_2D, ...; GL_RENDERBUFFER; GL_FRAMEBUFFER_DEFAULT: of the window
    std::uint32_t internal_format = 0, samples = 1;
    std::array<std::uint32_t, bits_kinds> bits{};
    std::uint32_t component_type = 0; ///< GL_UNSIGNED_NORMALIZED, GL_FLOAT, ...
    bool srgb = false;
    std::uint32_t format = 0, type = 0; ///< of the bytes, rows from the bottom; type 0: compressed to `format`
    std::vector<SurfaceLevel> levels;

    void fields(auto& archive) {
        archive(name, target, internal_format, samples, bits, component_type, srgb, format, type, levels);
    }
};

struct Shader {
    std::uint32_t stage = 0;
    std::string source;

    void fields(auto& archive) { archive(stage, source); }
};

/// An active attribute or output variable of a program.
struct Variable {
    std::string name;
    std::uint32_t type = 0;
    std::int32_t location = -1;

    void fields(auto& archive) { archive(name, type, location); }
};

struct Program {
    std::string name;
    std::vector<Shader> shaders;
    std::vector<Variable> attributes, outputs;

    void fields(auto& archive) { archive(name, shaders, attributes, outputs); }
};

} // namespace record_stream
