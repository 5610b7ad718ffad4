// Which raster state a quad of a pass is drawn with.
#pragma once

#include "pipeline/fragment_stream.hpp"
#include "pipeline/frame.hpp"

#include <cstdint>
#include <vector>

namespace pipeline {

class DrawStates {
  public:
    DrawStates() : states_(1) {}
    explicit DrawStates(const RasterState& all) : states_{all} {}
    /// @param draws of the frame
    DrawStates(const Pass& pass, std::size_t draws);

    const std::vector<RasterState>& all() const { return states_; }
    /// Index into all().
    std::uint32_t number(const FragmentStream& stream, QuadId quad) const {
        return of_draw_.empty() ? 0 : of_draw_[stream.draw_of(quad)];
    }
    const RasterState& of(const FragmentStream& stream, QuadId quad) const { return states_[number(stream, quad)]; }

  private:
    std::vector<RasterState> states_;
    std::vector<std::uint32_t> of_draw_; ///< by draw of the frame; empty: all have the first state
};

/// Whether a quad shows the front of its triangle.
inline bool shows_front(const RasterState& state, const FragmentStream& stream, QuadId quad) {
    return stream.triangles[stream.quads[quad].triangle].front != state.front_is_clockwise;
}

} // namespace pipeline
