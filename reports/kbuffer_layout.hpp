// Where the entries of a pixel lie in a k-buffer's floats, and which of them are empty.
#pragma once

#include "pipeline/output/kbuffer.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace reports {

class KBufferLayout {
  public:
    explicit KBufferLayout(const pipeline::ModifyProgram& program)
        : layers_(program.k()),
          entry_floats_(program.floats_per_entry()),
          pixel_floats_(program.floats_per_pixel()),
          depth_slot_(program.depth_slot()),
          colour_(program.entries_are_colours()),
          clear_(program.floats_per_pixel()) {
        program.clear(clear_.data());
    }

    std::uint32_t layers() const { return layers_; }
    std::uint32_t entry_floats() const { return entry_floats_; }
    std::uint32_t depth_slot() const { return depth_slot_; }
    /// An entry begins with red, green and blue.
    bool has_colour() const { return colour_; }

    std::span<const float> entry(std::span<const float> kbuffer, std::size_t pixel, std::uint32_t layer) const {
        return kbuffer.subspan(pixel * pixel_floats_ + std::size_t{layer} * entry_floats_, entry_floats_);
    }
    float depth(std::span<const float> kbuffer, std::size_t pixel, std::uint32_t layer) const {
        return entry(kbuffer, pixel, layer)[depth_slot_];
    }
    /// The entry still has the depth that a clear gives it: no fragment is stored there.
    bool is_empty(std::span<const float> kbuffer, std::size_t pixel, std::uint32_t layer) const {
        return depth(kbuffer, pixel, layer) == clear_[std::size_t{layer} * entry_floats_ + depth_slot_];
    }

  private:
    std::uint32_t layers_, entry_floats_, pixel_floats_, depth_slot_;
    bool colour_;
    std::vector<float> clear_;
};

} // namespace reports
