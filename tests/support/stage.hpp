// Scenes of flat sheets before an eye, whose pictures can be computed by hand.
#pragma once

#include "tests/support/replay.hpp"

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace support {

/// A rectangle across the view.
struct Sheet {
    double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0; ///< in pixels of the picture
    double distance = 1.0;                                   ///< before the eye
    glm::vec4 colour{1.0F};                                  ///< linear; transparent where alpha is below 1
    glm::vec3 normal{0.0F, 0.0F, 1.0F};
    bool ramp = false; ///< its colour times 0 to 1, in red from left to right, in green from top to bottom, no blue
};

/// The eye is in the origin and looks along -z, 90 degrees high: at distance d a picture is 2 d high. Sheets whose
/// edges are multiples of 1/256 pixel at distance 1 have exact corners.
class Stage {
  public:
    Stage(std::uint32_t width, std::uint32_t height);

    void add(const Sheet& sheet);
    /// Over the whole picture.
    void add_whole(double distance, const glm::vec4& colour, const glm::vec3& normal = {0.0F, 0.0F, 1.0F},
                   bool ramp = false);
    /// A spot light with a cone of 90 degrees; it looks along -z, or along z. At the eye and looking like it, a shadow
    /// map of as many texels as a square picture has pixels sees the same.
    void add_light(const glm::vec3& place, float range, bool along_z = false);

    Replay replay(const std::string& workload, const std::vector<std::string>& settings,
                  const std::string& camera = "0,0,0,0,0,-1,90") const;

    traces::Scene scene;
    std::uint32_t width, height;
};

/// Codes of 8 bits of the picture, or of another surface of that width.
glm::ivec4 codes_at(const std::vector<float>& colours, std::uint32_t width, std::size_t x, std::size_t y);

} // namespace support
