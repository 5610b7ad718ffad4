// What can be said about the entries of pixels, given the fragments that were drawn.
#pragma once

#include "tests/support/replay.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace support {

/// Floats of one pixel (number in row order).
std::vector<float> pixel_of(const Replay& replay, const std::vector<float>& kbuffer, std::size_t pixel);

/// Depths of the entries of a pixel that are not empty, in their order.
std::vector<float> depths_at(const pipeline::Frame& frame, const std::vector<float>& kbuffer, std::uint32_t x,
                             std::uint32_t y);

/// The entry that quad `quad` of the k-buffer pass makes at a pixel.
std::vector<float> entry_of(const Replay& replay, std::size_t pixel, pipeline::QuadId quad);

/// A cleared pixel after the program ran for the fragments of these quads, the last of the list first.
std::vector<float> entries_of_chain(const Replay& replay, std::size_t pixel,
                                    const std::vector<pipeline::QuadId>& chain);

/// The fragments of every pixel, for the lemma that hazards only remove fragments.
class TrueFragments {
  public:
    explicit TrueFragments(const Replay& replay) : replay_(&replay), quads_(quads_by_pixel(replay.kbuffer_stream())) {}

    /// Lemma L1: every pixel is sorted and a subset of its true fragments, none of them twice. Empty when it holds.
    std::string first_violation_of_l1(const std::vector<float>& kbuffer) const;

    const std::vector<std::vector<pipeline::QuadId>>& quads() const { return quads_; }

  private:
    std::string violation_at(const std::vector<float>& kbuffer, std::size_t pixel) const;

    const Replay* replay_;
    std::vector<std::vector<pipeline::QuadId>> quads_;
};

} // namespace support
