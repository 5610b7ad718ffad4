// Fragments that a geometry pass keeps per pixel, in order of arrival, for designs that put them into the entries later
// (specification 004, section 8: linked lists, stencil routing).
#pragma once

#include "pipeline/fragment_stream.hpp"
#include "pipeline/output/surface_layout.hpp"

#include <vector>

namespace pipeline {

/// Shared by the ROP partitions, each its own pixels.
class FragmentLists {
  public:
    explicit FragmentLists(const SurfaceLayout& layout)
        : fragments_(std::size_t{4} * layout.blocks()), overflowed_(fragments_.size()) {}

    void keep(std::uint32_t block, std::uint32_t pixel, QuadId quad) {
        fragments_[block * std::size_t{4} + pixel].push_back(quad);
    }
    void lose(std::uint32_t block, std::uint32_t pixel) { overflowed_[block * std::size_t{4} + pixel] = 1; }

    const std::vector<QuadId>& fragments(std::uint32_t block, std::uint32_t pixel) const {
        return fragments_[block * std::size_t{4} + pixel];
    }
    bool overflowed(std::uint32_t block, std::uint32_t pixel) const {
        return overflowed_[block * std::size_t{4} + pixel] != 0;
    }

  private:
    std::vector<std::vector<QuadId>> fragments_;
    std::vector<std::uint8_t> overflowed_;
};

} // namespace pipeline
