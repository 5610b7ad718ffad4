// The bytes of the k-buffer, in the two versions the hardware can hold of them.
//
// `latest` is what the ROP's tile cache or memory holds last; `memory` is what a read that bypasses the ROP's tile
// cache sees. The second plane exists only where a design makes the difference observable. Each block belongs to one
// ROP partition, and only that partition's component touches it during a run.
//
// With every pixel travels its version: the number of stores it contains by position (stores), and how many fragments
// are really in it (chain): chain < stores where an update was lost.
#pragma once

#include "pipeline/output/kbuffer.hpp"
#include "pipeline/output/surface_layout.hpp"

#include <vector>

namespace pipeline {

struct PixelVersion {
    std::uint32_t stores = 0;
    std::uint32_t chain = 0;
};

class KBufferMemory {
  public:
    /// @param split keep a separate memory-side plane
    KBufferMemory(const SurfaceLayout& layout, const ModifyProgram& program, bool split);

    const SurfaceLayout& layout() const { return layout_; }
    std::uint32_t floats_per_pixel() const { return floats_; }

    float* latest(std::uint32_t block, std::uint32_t pixel) { return latest_.data() + at(block, pixel); }
    PixelVersion& latest_version(std::uint32_t block, std::uint32_t pixel) {
        return latest_versions_[block * 4 + pixel];
    }

    /// What a read sees: the memory plane when `rop_view` is false and the planes are split.
    const float* seen(std::uint32_t block, std::uint32_t pixel, bool rop_view) const {
        return (split_ && !rop_view ? memory_ : latest_).data() + at(block, pixel);
    }
    PixelVersion seen_version(std::uint32_t block, std::uint32_t pixel, bool rop_view) const {
        return (split_ && !rop_view ? memory_versions_ : latest_versions_)[block * 4 + pixel];
    }
    /// Memory takes these pixels of a block: `values` and `versions` are those of all four.
    void publish_block(std::uint32_t block, std::uint32_t pixels, const float* values, const PixelVersion* versions);

    /// Sets every pixel to the program's initial value, version 0.
    void clear();
    /// Content of all places, row by row: width * rows * floats_per_pixel floats.
    std::vector<float> image() const;
    /// Per pixel, row by row: fragments stored minus fragments still contained.
    std::uint64_t lost_updates() const;
    std::uint64_t bytes() const;

  private:
    std::size_t at(std::uint32_t block, std::uint32_t pixel) const {
        return (static_cast<std::size_t>(block) * 4 + pixel) * floats_;
    }

    SurfaceLayout layout_;
    const ModifyProgram* program_;
    std::uint32_t floats_;
    bool split_;
    std::vector<float> latest_, memory_;
    std::vector<PixelVersion> latest_versions_, memory_versions_;
};

} // namespace pipeline
