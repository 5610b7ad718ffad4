// Pre-integrated transfer function: what a ray sees of a gap whose scalar runs linearly from s1 to s2.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <mutex>
#include <vector>

namespace models {

struct TransferPoint {
    float scalar = 0;
    glm::vec3 colour{0.0F}; ///< linear RGB, of what is seen where the medium is thick
    float extinction = 0;   ///< 1 / distance unit
};

/// Colour and extinction, linear between points of ascending scalars and constant outside them.
using TransferFunction = std::vector<TransferPoint>;

/// Table over (s1, s2, length), integrated when the first gap is asked for: programs are also made to be described.
///
/// A node holds the mean extinction of the gap and the mean of its colour weighted by what reaches the eye; opacity is
/// 1 - exp(-extinction * length) and the premultiplied colour is opacity * mean colour. Both of these are bounded and
/// vary slowly where the opacity itself does neither, so that trilinear interpolation of a constant field is exact for
/// gaps of any optical thickness.
class PreintegratedTable {
  public:
    /// Throws sim::InputError when scalars do not ascend, an extinction is negative or a number is not finite.
    PreintegratedTable(const TransferFunction& transfer, float longest, std::uint32_t scalars, std::uint32_t lengths);

    /// Premultiplied colour and opacity of a gap; scalars outside the transfer function count as its ends.
    glm::vec4 gap(float s1, float s2, float length) const;

  private:
    void integrate() const;
    glm::vec4 lookup(float s1, float s2, float length) const;

    TransferFunction transfer_;
    float first_, range_, longest_;
    std::uint32_t scalars_, lengths_;
    mutable std::once_flag integrated_;
    mutable std::vector<glm::vec4> nodes_; ///< mean colour, mean extinction; s1 fastest, then s2, then the length
};

} // namespace models
