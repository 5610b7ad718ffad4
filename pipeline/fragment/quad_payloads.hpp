// The registers of the quads in flight that hold k-buffer values: what a shader read, and what it will store.
//
// A slot belongs to whoever holds the message that names it (pipe, memory side, reorder buffer, ROP), so no two units
// touch it at one time. The scheduler hands slots out, the ROP's commit gives them back.
#pragma once

#include "pipeline/output/kbuffer_memory.hpp"
#include "sim/check.hpp"
#include "sim/time.hpp"

#include <algorithm>
#include <vector>

namespace pipeline {

struct QuadPayload {
    sim::Cycle dispatched = 0;
    sim::Cycle first_read = 0; ///< t_rd of the render target that was read first
    sim::Cycle last_read = 0;  ///< and of the one that was read last
    sim::Cycle last_fill = 0;  ///< latest array read that supplied any of the values
};

class QuadPayloads {
  public:
    QuadPayloads(std::uint32_t slots, std::uint32_t floats_per_pixel)
        : floats_(floats_per_pixel),
          payloads_(slots),
          values_(static_cast<std::size_t>(slots) * 4 * floats_per_pixel),
          versions_(values_.size() / 4),
          fills_(slots * std::size_t{floats_per_pixel / 4}) {
        for (std::uint32_t slot = slots; slot > 0; --slot) free_.push_back(slot - 1);
    }

    bool available() const { return !free_.empty(); }
    std::uint32_t take() {
        const std::uint32_t slot = free_.back();
        free_.pop_back();
        payloads_[slot] = {};
        payloads_[slot].first_read = ~sim::Cycle{0};
        return slot;
    }
    void give_back(std::uint32_t slot) { free_.push_back(slot); }

    QuadPayload& operator[](std::uint32_t slot) { return payloads_[slot]; }
    float* values(std::uint32_t slot, std::uint32_t pixel) {
        return values_.data() + (static_cast<std::size_t>(slot) * 4 + pixel) * floats_;
    }

    PixelVersion& version(std::uint32_t slot, std::uint32_t pixel, std::uint32_t target) {
        return versions_[(static_cast<std::size_t>(slot) * 4 + pixel) * (floats_ / 4) + target];
    }

    /// Array read that supplied this render target.
    sim::Cycle fill(std::uint32_t slot, std::uint32_t target) const {
        return fills_[slot * std::size_t{floats_ / 4} + target];
    }

    /// When a value was asked for, and when the array was read that supplied it: t_look and t_fill. A miss is asked for
    /// before its fill, a hit after it; the value is that of the later of the two, or older.
    struct ReadTimes {
        sim::Cycle look = 0;
        sim::Cycle fill = 0;
    };
    /// Copies one render target of one pixel into the slot, with its version and times.
    void sample(std::uint32_t slot, std::uint32_t pixel, std::uint32_t target, const float* four,
                PixelVersion version_read, ReadTimes times) {
        float* to = values(slot, pixel) + std::size_t{target} * 4;
        for (int channel = 0; channel < 4; ++channel) to[channel] = four[channel];
        version(slot, pixel, target) = version_read;
        fills_[slot * std::size_t{floats_ / 4} + target] = times.fill;
        QuadPayload& payload = payloads_[slot];
        const sim::Cycle read = std::max(times.look, times.fill);
        payload.first_read = std::min(payload.first_read, read);
        payload.last_read = std::max(payload.last_read, read);
        payload.last_fill = std::max(payload.last_fill, times.fill);
    }

  private:
    std::uint32_t floats_;
    std::vector<QuadPayload> payloads_;
    std::vector<float> values_;
    std::vector<PixelVersion> versions_;
    std::vector<sim::Cycle> fills_; ///< by slot and render target
    std::vector<std::uint32_t> free_;
};

} // namespace pipeline
