// The pictures of a report, as pure functions of what a run left behind.
#pragma once

#include "pipeline/run_result.hpp"
#include "reports/images.hpp"
#include "reports/kbuffer_layout.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace reports {

struct Size {
    std::uint32_t width = 0, height = 0; ///< pixels
    std::size_t pixels() const { return std::size_t{width} * height; }
};

/// Linear RGBA, four floats a pixel, encoded for a display; alpha is not shown.
Picture composite_picture(Size size, std::span<const float> rgba);

/// Nearest and furthest window depth that any entry of a k-buffer holds; {0, 1} when all are empty.
struct DepthRange {
    float near = 0, far = 1;
};
DepthRange depth_range(const KBufferLayout& layout, std::span<const float> kbuffer, std::size_t pixels);

/// One layer: its colours when entries have any, else its depths, white (range.near) to dark red (range.far), with a
/// scale below. Pixels without an entry are chequered.
Picture layer_picture(Size size, const KBufferLayout& layout, std::span<const float> kbuffer, std::uint32_t layer,
                      DepthRange range);

/// The four classes of hazards (specification 004, section 7.1) in fixed colours over a dimmed grey composite, with a
/// legend below. Where several classes happened the highest is shown. `mask` may be empty: no hazards.
Picture hazard_picture(Size size, std::span<const float> rgba, std::span<const std::uint8_t> mask,
                       const pipeline::HazardCounts& counts, const std::string& design);
Colour hazard_colour(std::size_t kind); ///< kind 0 to 3

/// The largest difference of a pixel's red, green or blue (linear light), 0 to 1.
float pixel_difference(std::span<const float> rgba, std::span<const float> reference, std::size_t pixel);

/// The power of two in [1, 256] that brings 99 of 100 differing pixels of all runs up to at most 1; 1 without any.
class DifferenceScale {
  public:
    void note(Size size, std::span<const float> rgba, std::span<const float> reference);
    std::uint32_t factor() const;

  private:
    static constexpr std::size_t bins = 10;
    std::array<std::uint64_t, bins> counts_{}; ///< bin i: difference in (2^-(i+1), 2^-i]
};

/// Differences to the reference times `factor`, as heat, with a scale below. Pixels of `wrong` (may be empty) whose
/// composite is equal have a colour of their own: their k-buffer differs.
Picture difference_picture(Size size, std::span<const float> rgba, std::span<const float> reference,
                           std::span<const std::uint8_t> wrong, std::uint32_t factor, const std::string& design);

/// One value a pixel in grey, shown.low black and shown.high white, with a scale below.
Picture value_picture(Size size, std::span<const float> values, const pipeline::SurfacePicture& shown);

/// Fragments per pixel as heat, with a scale below.
Picture overlap_picture(Size size, std::span<const std::uint32_t> depth_complexity);

} // namespace reports
