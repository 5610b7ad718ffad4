// Memory for contents that are read one after the other.
#pragma once

#include "sim/large_pages.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace traces::rtrace {

/// Small contents share blocks of memory in large pages of the host, as thousands of textures have tens of thousands of
/// small pages. A block lives as long as one of the contents in it.
class ContentBlocks {
  public:
    /// Not cleared.
    /// @param left bytes of this content and of all that are still to come: no block is made for more
    std::shared_ptr<std::byte[]> take(std::size_t bytes, std::uint64_t left) {
        if (bytes > block_bytes / 4) return sim::large_block(bytes);
        const std::size_t room = (bytes + alignment - 1) / alignment * alignment;
        if (room > free_.size()) {
            const std::size_t size = std::max<std::size_t>(room, std::min<std::uint64_t>(left, block_bytes));
            block_ = sim::large_block(size);
            free_ = {block_.get(), size};
        }
        std::shared_ptr<std::byte[]> taken(block_, free_.data());
        free_ = free_.subspan(room);
        return taken;
    }

  private:
    static constexpr std::size_t block_bytes = std::size_t{1} << 24U, alignment = 64;

    std::shared_ptr<std::byte[]> block_;
    std::span<std::byte> free_;
};

} // namespace traces::rtrace
