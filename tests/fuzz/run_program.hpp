// A modify program that somebody wrote, run for a few fragments: it must leave finite floats.
#pragma once

#include "pipeline/output/kbuffer.hpp"
#include "sim/check.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace fuzz {

inline void run_program(const pipeline::ModifyProgram& program) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::vector<float> pixel(program.floats_per_pixel());
    program.clear(pixel.data());
    std::array<float, pipeline::largest_entry> entry{};
    const std::array<float, 4> rgba{0.5F, std::numeric_limits<float>::quiet_NaN(), infinity, -1e-40F};
    for (const float depth : {0.5F, 0.25F, 0.0F, 1.0F, -infinity}) {
        program.make_entry({rgba.data(), depth, 3}, entry.data());
        program.insert(pixel.data(), entry.data());
    }
    program.drain(pixel.data());
    for (const float value : pixel) CHECK(std::isfinite(value));
}

} // namespace fuzz
