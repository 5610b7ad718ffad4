// Runs code over the floats of a pixel.
#pragma once

#include "models/programs/language/code.hpp"

#include <array>
#include <span>
#include <vector>

namespace models::language {

struct Step;

/// What a run works with beside the pixel.
struct Frame {
    std::uint32_t changed = 0; ///< bits of the pixel's floats that ever differed
    // Not initialised: a variable is written before it is read.
    alignas(16) std::array<float, most_constants + most_locals> own;
};

/// An instruction made ready to run. There is one function for every way in which its operands can lie in the pixel or
/// among the run's own floats, because asking at each operand where it lies takes longer than the operation itself.
struct Step {
    /// Returns the step to do next.
    using Function = const Step* (*)(const Step*, float* pixel, Frame&);
    Function run = nullptr;      ///< none: the end
    Operand a = 0, b = 0, c = 0; ///< places in the pixel or in the run's own floats
    Operand d = 0;               ///< the same; steps to jump; floats of an entry of a computed number
    std::uint16_t count = 1;     ///< floats; the last entry, if its number is computed
};

/// Code made ready to run, by any number of threads at once.
class Script {
  public:
    explicit Script(const Code& code);

    /// One run over a pixel, with `inputs`, which are finite, as the first variables. Returns whether a float of the
    /// pixel changed at any time.
    bool run(float* pixel, std::span<const float> inputs) const;

  private:
    std::vector<Step> steps_;
    std::vector<float> constants_;
};

} // namespace models::language
