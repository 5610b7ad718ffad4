// The contract of the last pass of a frame: how finished surfaces become the picture (specification 004, workload W2,
// pass 2). A workload whose picture no shader of a pass makes implements it.
//
// The picture is a pure function. Where its time matters, as in a shadow kernel that takes longer than all the rest,
// the workload also says which full-screen passes compute it and what each quad of them fetches and executes; else the
// pass takes no time.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace pipeline {

struct Frame;

/// What the passes before left behind, row 0 first.
struct FinishedSurfaces {
    /// program->floats_per_pixel() floats per pixel of the k-buffer's view, as the last fragment and the program's
    /// drain left them.
    std::span<const float> kbuffer;
    std::span<const float> colour; ///< RGBA floats per pixel, or nothing when no pass wrote the colour surface
    std::span<const float> depth;  ///< window depth per pixel, likewise
};

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
    /// 64-byte line of a fetch, below 2^38; lines of different surfaces differ.
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

/// A surface on the way to the picture, to be looked at and measured.
struct ResolveImage {
    std::string name; ///< a file's name without its ending
    std::string title;
    std::uint32_t width = 0, height = 0;
    std::vector<float> values; ///< one per pixel, finite
    float low = 0, high = 1;   ///< what is shown as black and as white
};

class Resolve {
  public:
    virtual ~Resolve() = default;

    /// Linear RGBA, four floats per pixel of frame.view, row 0 first. Every float of the picture is finite.
    virtual std::vector<float> picture(const Frame& frame, const FinishedSurfaces& surfaces) const = 0;

    /// The passes that compute it, in order. They may depend on the surfaces and outlive them.
    virtual std::vector<ScreenPass> screen_passes(const Frame&, const FinishedSurfaces&) const { return {}; }
    /// What lies on the way to `picture`, which picture() gave for the same surfaces.
    virtual std::vector<ResolveImage> images(const Frame&, const FinishedSurfaces&,
                                             std::span<const float> /*picture*/) const {
        return {};
    }
};

} // namespace pipeline
