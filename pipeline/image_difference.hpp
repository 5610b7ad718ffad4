// How the k-buffer of a run differs from the reference: per pixel, and layer by layer.
#pragma once

#include "pipeline/output/kbuffer.hpp"
#include "pipeline/run_result.hpp"

#include <span>
#include <vector>

namespace pipeline {

struct KBufferDifference {
    std::vector<std::uint8_t> wrong; ///< per pixel: 1 where any bit differs
    std::vector<std::uint8_t> tied;  ///< per pixel: 1 where it is wrong and the depths of all entries are equal
    std::uint64_t wrong_pixels = 0;
    std::uint64_t lost_fragments = 0; ///< entries of the reference that no layer of the run holds
    std::vector<LayerErrors> layers;
};

/// Both images hold floats_per_pixel() floats per pixel. Entries that equal the cleared entry are empty.
KBufferDifference compare_kbuffers(const ModifyProgram& program, std::span<const float> run,
                                   std::span<const float> reference);

} // namespace pipeline
