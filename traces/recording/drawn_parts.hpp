// What a frame has in place of the surfaces of a recording: passes draw to whole surfaces of one plane and one level,
// so that a level or plane which is drawn to is a surface of its own where its surface has others.
#pragma once

#include "pipeline/surface_info.hpp"
#include "pipeline/texture_lookup.hpp"
#include "traces/recording/recording.hpp"

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace traces {

/// A level of a plane, and the surface of the frame that has its texels.
struct DrawnPart {
    std::uint32_t level = 0, plane = 0;
    std::uint32_t surface = 0;
};

class DrawnParts {
  public:
    explicit DrawnParts(const Recording& recording);

    /// Those of the recording, in its order, then the parts. Throws sim::InputError as surface_of() does.
    std::vector<pipeline::SurfaceInfo> surfaces() const;
    /// What is drawn to, or copied from, as a target of these surfaces.
    TargetSet::Target of(const TargetSet::Target& target) const;
    TargetSet of(TargetSet targets) const;
    /// Of a surface of the recording that has others than what is drawn to.
    std::vector<DrawnPart> parts_of(std::uint32_t surface) const;

  private:
    void add(const TargetSet::Target& target);

    const Recording& recording_;
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::uint32_t> parts_; ///< surface, level, plane
};

} // namespace traces
