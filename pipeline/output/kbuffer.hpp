// The contract between the pipeline and a k-buffer: *what* a fragment does to the entries of its pixel (ModifyProgram,
// implemented in models/programs), and *when* and under which protection that happens (KBufferDesign, implemented in
// models/kbuffers). The pipeline knows nothing else about either.
//
// Layout of a pixel: `k` entries of `floats_per_entry` floats, entry 0 first, then `state_floats` floats that belong to
// the pixel as a whole (a colour that a program composites into, say), packed without gaps and padded to a multiple of
// four floats. Four consecutive floats are one RGBA32F render target, so rgbz uses one target per entry and z packs
// four depths into each (specification 004, section 2.3).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace pipeline {

/// Operations of one run of a program for one fragment, in scalar ALU operations.
struct ProgramCost {
    std::uint32_t operations = 0;
};

/// Floats that an entry has at most.
inline constexpr std::uint32_t largest_entry = 8;
/// Render targets that hold one pixel at most: their masks have 64 bits.
inline constexpr std::uint32_t most_targets = 64;

enum class OrderNeed : std::uint8_t { any, primitive_order };

/// Which geometry passes with a fixed-function depth test give the same entries; see KBufferDesign.
enum class Peeling : std::uint8_t {
    none,    ///< no passes do
    nearest, ///< entry i is the i-th nearest fragment
    ranges,  ///< entry i is the nearest fragment whose depth lies in range i
};

/// A range of window depths, near included, far excluded.
struct DepthInterval {
    float near = 0, far = 0;
};

/// What a program may read of a shaded fragment.
struct Fragment {
    const float* rgba = nullptr; ///< linear RGBA of the shader, four floats; null when the program needs no colour
    float depth = 0;             ///< window depth
    std::uint32_t draw = 0;      ///< index into Frame::draws
};

/// A pure function over (entries of a pixel, fragment). Source: Bavoil 2007, section 4.3 (A5).
class ModifyProgram {
  public:
    virtual ~ModifyProgram() = default;

    virtual std::string_view id() const = 0;
    virtual std::string_view summary() const = 0;
    /// Entries per pixel, 1 to 64.
    std::uint32_t k() const { return k_; }
    /// Floats per entry: 1 (depth) to largest_entry.
    std::uint32_t floats_per_entry() const { return floats_; }
    /// Floats of a pixel behind its entries.
    std::uint32_t state_floats() const { return state_; }
    /// RGBA32F render targets that hold one pixel: ceil((k * floats_per_entry + state_floats) / 4).
    std::uint32_t targets() const { return (k_ * floats_ + state_ + 3) / 4; }
    std::uint32_t floats_per_pixel() const { return targets() * 4; }
    std::uint32_t bytes_per_pixel() const { return targets() * 16; }

    virtual ProgramCost cost() const = 0;
    virtual OrderNeed order_need() const = 0;
    virtual bool needs_texture() const = 0; ///< fetches a table: no programmable blender can run it
    virtual bool needs_colour() const = 0;  ///< reads more of the fragment than its depth
    /// Index of the depth within an entry.
    virtual std::uint32_t depth_slot() const = 0;
    /// An entry begins with red, green and blue.
    virtual bool entries_are_colours() const { return needs_colour() && floats_ >= 4; }
    /// No entry is nearer than the one before it.
    virtual bool entries_are_sorted() const { return peeling() != Peeling::ranges; }

    /// Depth of an entry that holds no fragment; the last entry's, as some programs start from other ones.
    float cleared_depth() const {
        std::vector<float> pixel(floats_per_pixel());
        clear(pixel.data());
        return pixel[(k_ - 1) * floats_ + depth_slot()];
    }
    /// Initial content of one pixel: floats_per_pixel() floats.
    virtual void clear(float* pixel) const = 0;
    /// Runs the program for one fragment. `fragment` has floats_per_entry() floats in the entry's own layout.
    /// Returns true when it changed the pixel.
    virtual bool insert(float* pixel, const float* fragment) const = 0;
    /// Lays a shaded fragment out as an entry: floats_per_entry() floats.
    virtual void make_entry(const Fragment& fragment, float* entry) const = 0;

    /// What is left to do with a pixel after its last fragment, before the picture is made; most programs do nothing.
    virtual bool drains() const { return false; }
    virtual void drain(float*) const {}

    virtual Peeling peeling() const { return Peeling::none; }
    /// Of entry i, when peeling() is by ranges.
    virtual DepthInterval range(std::uint32_t) const { return {}; }

  protected:
    ModifyProgram(std::uint32_t k, std::uint32_t floats, std::uint32_t state = 0)
        : k_(k), floats_(floats), state_(state) {}

  private:
    std::uint32_t k_;
    std::uint32_t floats_;
    std::uint32_t state_;
};

} // namespace pipeline
