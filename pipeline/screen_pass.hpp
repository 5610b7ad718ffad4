// The pass over the screen that works on lists of fragments (list_sort.hpp), as the fragment pipes see it: what each of
// its quads fetches, executes, loads and stores. Shaders of frames are those of shader.hpp.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace pipeline {

/// A load or store of a quad past all caches, within 64 bytes.
struct MemorySegment {
    std::uint64_t address = 0;
    std::uint32_t bytes = 0;
    bool write = false;
};

/// What the shader of a full-screen pass does, by quad. Pixel (x, y), both even, is the upper left one of the quad. The
/// quad runs as long as its longest pixel; where pixels fetch from different lines, the first pixel's counts.
class ScreenShader {
  public:
    virtual ~ScreenShader() = default;
    virtual std::uint32_t alu(std::uint32_t x, std::uint32_t y) const = 0; ///< instructions, each issued once
    virtual std::uint32_t fetches(std::uint32_t x, std::uint32_t y) const = 0;
    /// 64-byte line of GPU memory that a fetch reads.
    virtual std::uint64_t line(std::uint32_t x, std::uint32_t y, std::uint32_t fetch) const = 0;

    /// Loads and stores behind the fetches that depend on each other: those of one step go out together, and the next
    /// step begins when the loads are back.
    virtual std::uint32_t steps(std::uint32_t, std::uint32_t) const { return 0; }
    /// Appends what step `number` loads and stores.
    virtual void step(std::uint32_t, std::uint32_t, std::uint32_t /*number*/, std::vector<MemorySegment>&) const {}
};

/// A pass over all pixels of a surface that reads others and tests nothing.
struct ScreenPass {
    std::string name;
    std::uint32_t width = 0, height = 0;
    std::uint32_t written_bytes = 0; ///< per pixel
    std::uint32_t texel_bytes = 4;   ///< of what it fetches: 4 to 16
    std::uint32_t registers = 4;
    std::shared_ptr<const ScreenShader> shader;
};

} // namespace pipeline
