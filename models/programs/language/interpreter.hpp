// Runs code over the floats of a pixel.
#pragma once

#include "models/programs/language/code.hpp"

#include <array>

namespace models::language {

/// One run of code over a pixel, with variables of its own.
class Run {
  public:
    explicit Run(const Code& code);

    float& input(std::uint32_t i) { return own_[i]; }
    /// Returns whether a float of the pixel changed at any time.
    bool execute(float* pixel);

  private:
    const Code& code_;
    std::array<float, most_locals + most_constants> own_;
};

} // namespace models::language
