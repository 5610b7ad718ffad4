// Single numbers of a run by name, for studies.
#pragma once

#include "reports/comparison_result.hpp"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace reports {

/// A name is the path of a number in the design's part of result.json ("cycles", "hazards.per_million",
/// "stages.rop.counters.kbuffer_tiles.hits", "caches.kbuffer_tiles.hit_rate"), or one of
///   wrong_share         pixels that differ from the reference, over pixels that anything was drawn on
///   colour_error        mean difference of their red, green and blue to the reference, linear, 0 to 1
///   colour_error_worst  the largest difference of a channel of a pixel
///   pass.NAME.VALUE     of a pass of the frame, over all passes that the design makes of it: ms, share (of the frame's
///                       cycles), dram_mb, mtriangles_per_s (of the scene, in the time of the pass)
///   kbuffer.VALUE       of the pass that fills the k-buffer: the same, mtexels_per_s (entries captured in its time),
///                       ms_per_layer and dram_mb_per_layer
class RunValues {
  public:
    RunValues(const Comparison& comparison, std::size_t run);

    /// The number, or the quotient "A / B"; nothing where the run has none of that name, or B is 0.
    std::optional<double> at(std::string_view value) const;
    std::vector<std::string> names() const;

  private:
    std::optional<double> number(const std::string& name) const;
    void read_picture(const Comparison& comparison, std::size_t run);
    void read_passes(const Comparison& comparison, const pipeline::RunResult& run);

    std::map<std::string, double> numbers_;
};

/// How much a picture moves from run to run: the artefacts flicker where latencies vary.
class FrameChange {
  public:
    /// Composites of equal frames, one after the other.
    void add(const Comparison& comparison, std::size_t run);

    /// Of each drawn pixel the largest difference of a channel between any two runs; mean over pixels and worst.
    double mean() const;
    double worst() const;

  private:
    float change(std::size_t pixel) const;

    std::vector<std::size_t> drawn_;
    std::vector<float> low_, high_; ///< RGB of each drawn pixel
};

} // namespace reports
