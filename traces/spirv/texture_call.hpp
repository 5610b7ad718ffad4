// An instruction that reads a texture, resolved.
#pragma once

#include "traces/spirv/program.hpp"

#include <array>
#include <optional>

namespace traces::spirv {

/// A texture with the sampler that reads it.
struct TextureReference {
    Id type = 0;               ///< of the image or sampled image
    std::uint32_t texture = 0; ///< index into Program::textures
    std::uint32_t sampler = 0;
    std::uint32_t element = 0, sampler_element = 0;
    std::optional<Slot> varying{}; ///< the element, clamped to the array
};

struct TextureCall {
    TextureReference reference;
    ImageType image;
    Slot place = 0;
    std::uint32_t coordinates = 2; ///< with the layer; without what divides them
    std::optional<Slot> divisor{}; ///< of projective calls
    LevelOfDetail level = LevelOfDetail::implicit;
    std::optional<Slot> lod{}, dx{}, dy{}, reference_depth{}, sample{};
    std::array<std::optional<Slot>, 3> offset{};
    bool gathers = false;
    std::optional<Slot> component{};
    std::array<std::optional<Slot>, 8> offsets{}; ///< of the four texels of a gather: x, y each
};

void sample_texture(Run& run, const Operation& operation); ///< a: the call. The results are as the instruction's
void fetch_texture(Run& run, const Operation& operation);
void texture_size(Run& run, const Operation& operation);
void texture_levels(Run& run, const Operation& operation);
void texture_samples(Run& run, const Operation& operation);
void texture_level(Run& run, const Operation& operation);

} // namespace traces::spirv
