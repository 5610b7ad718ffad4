// What the shader of a quad does, as the code that computes its values records it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace pipeline {

class QuadWork {
  public:
    /// One read of a surface by the pixels of a quad.
    struct Fetch {
        std::uint32_t first = 0, count = 0; ///< of its distinct lines in `lines`, in order of the pixels
        std::uint32_t texel_bytes = 4;
    };

    /// Instructions that these pixels (mask) execute; a quad runs as long as its longest pixel.
    void issue(std::uint32_t instructions, unsigned pixels) {
        for (std::size_t i = 0; i < 4; ++i) issued_[i] += ((pixels >> i) & 1U) != 0 ? instructions : 0U;
    }
    void begin_fetch(std::uint32_t texel_bytes) {
        fetches_.push_back({static_cast<std::uint32_t>(lines_.size()), 0, texel_bytes});
    }
    /// A byte address in GPU memory that the read begun last touches.
    void touch(std::uint64_t address) {
        Fetch& fetch = fetches_.back();
        const std::uint64_t line = address / line_bytes;
        const auto begin = lines_.begin() + fetch.first;
        if (std::find(begin, lines_.end(), line) != lines_.end()) return;
        lines_.push_back(line);
        begun_bytes_.push_back(fetch.count++ == 0 ? fetch.texel_bytes : 0);
    }
    void clear() {
        issued_ = {};
        fetches_.clear();
        lines_.clear();
        begun_bytes_.clear();
    }

    std::uint32_t instructions() const { return *std::max_element(issued_.begin(), issued_.end()); }
    std::span<const Fetch> fetches() const { return fetches_; }
    /// Of all fetches, one after the other.
    std::span<const std::uint64_t> lines() const { return lines_; }
    /// Bytes of a texel of the fetch whose first line this is in lines(); 0: a further line of one.
    std::uint32_t bytes_begun_with(std::size_t line) const { return begun_bytes_[line]; }
    /// Numbers of 64-byte lines of GPU memory.
    std::span<const std::uint64_t> lines(const Fetch& fetch) const {
        return std::span(lines_).subspan(fetch.first, fetch.count);
    }

  private:
    static constexpr std::uint64_t line_bytes = 64;

    std::array<std::uint32_t, 4> issued_{}; ///< by pixel
    std::vector<Fetch> fetches_;
    std::vector<std::uint64_t> lines_;
    std::vector<std::uint32_t> begun_bytes_; ///< by line
};

} // namespace pipeline
