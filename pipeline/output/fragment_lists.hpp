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
    struct Node {
        QuadId quad = 0;
        std::uint32_t number = 0; ///< of the fragments kept by the partition of its pixel
    };

    explicit FragmentLists(const SurfaceLayout& layout)
        : layout_(layout), fragments_(std::size_t{4} * layout.blocks()), overflowed_(fragments_.size()) {}

    void keep(std::uint32_t block, std::uint32_t pixel, Node node) {
        fragments_[block * std::size_t{4} + pixel].push_back(node);
    }
    void clear() {
        for (std::vector<Node>& list : fragments_) list.clear();
    }
    void lose(std::uint32_t block, std::uint32_t pixel) { overflowed_[block * std::size_t{4} + pixel] = 1; }

    const SurfaceLayout& layout() const { return layout_; }
    const std::vector<Node>& fragments(std::uint32_t block, std::uint32_t pixel) const {
        return fragments_[block * std::size_t{4} + pixel];
    }
    bool overflowed(std::uint32_t block, std::uint32_t pixel) const {
        return overflowed_[block * std::size_t{4} + pixel] != 0;
    }

    /// Where byte `byte` of a partition's nodes lies. The counter gives memory out in the order in which quads ask for
    /// it, whatever their partition: those of the partitions alternate, in chunks.
    static std::uint64_t address(std::uint32_t partition, std::uint32_t partitions, std::uint64_t byte) {
        return pool_address + (byte / chunk * partitions + partition) * chunk + byte % chunk;
    }

    static constexpr std::uint64_t pool_address = std::uint64_t{1} << 42U;
    static constexpr std::uint32_t chunk = 256;

  private:
    SurfaceLayout layout_;
    std::vector<std::vector<Node>> fragments_;
    std::vector<std::uint8_t> overflowed_;
};

} // namespace pipeline
