// Whole surfaces as numbers, place after place in row order: what reports look at.
#pragma once

#include "pipeline/surface.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace pipeline {

/// RGBA, four floats a place. Empty for no_surface, as below.
std::vector<float> colours_of(const SurfaceStore& surfaces, SurfaceId surface);
/// One channel of them.
std::vector<float> channel_of(const SurfaceStore& surfaces, SurfaceId surface, std::uint32_t channel);
/// Window depths; empty where the format has none.
std::vector<float> depths_of(const SurfaceStore& surfaces, SurfaceId surface);
/// Empty where the format has no stencil.
std::vector<std::uint8_t> stencils_of(const SurfaceStore& surfaces, SurfaceId surface);
/// The program's floats of every place of a k-buffer.
std::vector<float> entries_of(const SurfaceStore& surfaces, SurfaceId kbuffer);
/// The other way round; places that hold what a clear stores stay unwritten.
void store_entries(SurfaceStore& surfaces, SurfaceId kbuffer, std::span<const float> entries);

} // namespace pipeline
