// The table of a fast clear: a bit for each sector of a surface that holds nothing but the value it was cleared to.
//
// Modelled: a cleared sector is not fetched when it is first touched, as its content is known; the first write-back of
// one writes all its pixels, as memory holds none of them, and ends its state. Readers on the memory side know nothing
// of the table: before they read the surface, what is still cleared is written (a resolve).
// Not modelled: a hierarchy of the table, time to look it up.
#pragma once

#include "pipeline/output/surface_layout.hpp"

#include <cstdint>
#include <vector>

namespace pipeline {

class ClearBits {
  public:
    /// The whole surface was cleared.
    void set(const SurfaceLayout& layout) {
        cleared_.assign(layout.blocks(), 1);
        left_ = 0;
        for (std::uint32_t block = 0; block < layout.blocks(); ++block)
            left_ += layout.inside(layout.block_x(block), layout.block_y(block)) ? 1 : 0;
    }
    /// Nothing is cleared: the surface lies in memory.
    void reset() {
        cleared_.clear();
        left_ = 0;
    }
    bool cleared(std::uint32_t block) const { return left_ != 0 && block < cleared_.size() && cleared_[block] != 0; }
    void written(std::uint32_t block) {
        if (!cleared(block)) return;
        cleared_[block] = 0;
        --left_;
    }
    std::uint64_t left() const { return left_; } ///< sectors of the picture that are still cleared

  private:
    std::vector<std::uint8_t> cleared_; ///< by block; empty: none
    std::uint64_t left_ = 0;
};

} // namespace pipeline
