// What the driver makes of the calls that draw, in frames that are wanted: its own counters, positions by transform
// feedback, pictures. For glretrace, which it goes into by LD_PRELOAD; it records nothing.
//
// Environment: MEASURE_MESA names the folder for the results. MEASURE_MESA_FRAMES is "first:last"; frames count from 0,
// one ends at each swap of buffers, and behind the last one the program ends. MEASURE_MESA_PICTURES has a number for
// each of these frames, with commas between: a picture is taken after every so many calls; 0: none.
// MEASURE_MESA_ISOTROPIC: samplers have one probe.
//
// calls.txt has a line for each call, and one for each frame, behind its calls:
//     call FRAME NAME VERTICES PRIMITIVES SAMPLES POSITIONS WIDTH HEIGHT DRAWS {MODE VERTICES}
//     frame FRAME WIDTH HEIGHT
// VERTICES, PRIMITIVES and SAMPLES are the driver's counters; -1: not measured. positions.bin has four floats for each
// position, pictures.bin four bytes for each pixel, bottom row first, both in the order of the lines.
#pragma once

#include "traces/record_module/functions.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <optional>
#include <vector>

namespace measure {

/// A draw as the program asked for it.
struct SubmittedDraw {
    GLenum mode = 0;
    std::int64_t vertices = -1; ///< of all instances; -1: the driver alone knows
};

/// One call, with all draws that it stands for: several of a multi-draw or of a display list.
struct DrawingCall {
    const char* name = "";
    std::vector<SubmittedDraw> draws;
};

struct Counts {
    std::int64_t vertices = -1, primitives = -1, samples = -1;
};

/// One of the driver's counters, from now on; nothing where the program counts with it itself.
class Counter {
  public:
    explicit Counter(GLenum target);
    std::int64_t stop();

  private:
    GLenum target_;
    GLuint query_ = 0;
};

/// All of them.
class Meter {
  public:
    Meter();
    Counts stop();

  private:
    Counter vertices_, primitives_, samples_;
};

/// Four floats for each position.
using Positions = std::vector<float>;

class Measurement {
  public:
    Measurement();
    /// Whether what is drawn now belongs to a frame that is wanted.
    bool wanted() const { return calls_ != nullptr && frame_ >= first_ && frame_ <= last_; }
    bool isotropic() const { return isotropic_; }

    /// Lets the driver perform the call between its counters; then asks for its positions.
    void measure(const DrawingCall& call, const std::function<void()>& perform,
                 const std::function<Positions(const Counts&)>& positions);
    /// The call was performed with these counts.
    void add(const DrawingCall& call, const Counts& counts, const Positions& positions);
    /// Buffers are about to be swapped.
    void end_frame();

  private:
    std::FILE *calls_ = nullptr, *positions_ = nullptr, *pictures_ = nullptr;
    std::uint32_t first_ = 0, last_ = 0, frame_ = 0;
    std::uint32_t calls_of_frame_ = 0;
    std::vector<std::uint32_t> strides_; ///< calls from one picture to the next, of each wanted frame
    bool isotropic_ = false;
};

/// The one of this process; lives until its end.
Measurement& measurement();

} // namespace measure
