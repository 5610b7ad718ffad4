// What Mesa makes of an apitrace file: glretrace plays it with measure_mesa.so, which counts, captures and takes
// pictures while it does. Nothing of ropsim takes part but the functions by which that library gets in.
#pragma once

#include "tests/replay_oracle/picture.hpp"
#include "traces/recording/virtual_display.hpp"

#include <cstdint>
#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <vector>

namespace replay_oracle {

/// A draw as the program asked for it.
struct SubmittedDraw {
    std::uint32_t mode = 0;     ///< of OpenGL
    std::int64_t vertices = -1; ///< of all instances; -1: Mesa alone knows
};

/// A call that draws: one draw, or those of a multi-draw or of a display list.
struct MesaCall {
    std::string name;
    std::vector<SubmittedDraw> draws;
    std::int64_t vertices = -1, primitives = -1, samples = -1; ///< Mesa's counters; -1: not measured
    /// In clip space. Of lists those of triangles that Mesa makes of them; of others one for each vertex, in their
    /// order. Empty: not measured.
    std::vector<glm::vec4> positions;
    std::optional<Picture> picture; ///< behind it, of the first colour that it drew to

    bool is_list() const { return name == "glCallList" || name == "glCallLists" || name == "glEndList"; }
};

struct MesaFrame {
    std::vector<MesaCall> calls;
    std::optional<Picture> shown;
};

struct MesaRequest {
    std::filesystem::path trace;
    std::uint32_t first = 0;            ///< frame, counted from 0
    std::vector<std::uint32_t> strides; ///< of each frame: a picture after every so many calls; 0: none
    bool isotropic = true;              ///< samplers with one probe
};

/// Throws sim::InputError where glretrace does not get to the end of the last frame.
std::vector<MesaFrame> replay_by_mesa(const MesaRequest& request);

/// The library that goes into glretrace.
std::filesystem::path measuring_library();

/// Mesa's software renderer, and an X server where there is none, for the programs that are started while it lives.
class SoftwareGraphics {
  public:
    /// Throws sim::InputError where there is no X server and none starts.
    SoftwareGraphics();
    ~SoftwareGraphics();
    SoftwareGraphics(const SoftwareGraphics&) = delete;
    SoftwareGraphics& operator=(const SoftwareGraphics&) = delete;

  private:
    std::optional<traces::VirtualDisplay> display_;
};

/// A folder that goes with its content.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

} // namespace replay_oracle
