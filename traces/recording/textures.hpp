// Textures of recorded draws, as shaders read them: the surface and the sampler that a draw binds to each variable.
//
// Variables without a binding, and arrays of multisampled textures, read (0, 0, 0, 1) and have size 0; their names are
// kept and their reads counted.
#pragma once

#include "pipeline/functional/quad_sampler.hpp"
#include "pipeline/surface_access.hpp"
#include "traces/recording/recording.hpp"
#include "traces/spirv/program.hpp"
#include "traces/spirv/textures.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace traces {

/// The surface as the pipeline keeps it, with what it holds at first. Cleared to 0. Throws sim::InputError where a
/// level has another number of bytes than its size asks for.
pipeline::SurfaceInfo surface_of(const RecordedSurface& surface);

/// What a draw binds to the texture variables of a program. Made once for a draw; all threads may read it.
class TextureTable {
  public:
    struct Entry {
        bool bound = false;
        pipeline::TextureView view;
        pipeline::SamplerState sampler;
    };

    /// The shader knows the surface of bindings[i] as slots[i] of its SurfaceAccess. Of several bindings of a variable
    /// the last one counts; those of variables that the program does not have do not matter.
    /// @param parts of the surface of each binding that other slots have; empty: none
    TextureTable(const spirv::Program& program, std::span<const TextureBinding> bindings,
                 std::span<const RecordedSampler> samplers, std::span<const std::uint32_t> slots,
                 std::span<const std::vector<pipeline::TexturePart>> parts = {});

    const Entry& at(std::uint32_t texture, std::uint32_t element) const { return entries_[texture][element]; }
    /// "name" or "name[2]" of all without a binding, in the program's order.
    const std::vector<std::string>& unbound() const { return unbound_; }

  private:
    std::vector<std::vector<Entry>> entries_; ///< by variable of the program and element
    std::vector<std::string> unbound_;
};

/// For one quad after the other of one thread.
class BoundTextures : public spirv::ShaderTextures {
  public:
    /// Both outlive it.
    BoundTextures(pipeline::SurfaceAccess& surfaces, const TextureTable& table) : surfaces_(surfaces), table_(table) {}

    spirv::Texels sample(const spirv::TextureSample& call) override;
    spirv::Texels fetch(const spirv::TextureFetch& call) override;
    spirv::TextureSize size(std::uint32_t texture, std::uint32_t element, std::int32_t level) override;
    std::int32_t levels(std::uint32_t texture, std::uint32_t element) override;
    std::int32_t samples(std::uint32_t texture, std::uint32_t element) override;
    spirv::Texels level(const spirv::TextureSample& call) override;

    /// Reads of variables without a binding.
    std::uint64_t unbound_reads() const { return unbound_reads_; }

  private:
    spirv::Texels unbound(const spirv::ImageType& image);

    pipeline::SurfaceAccess& surfaces_;
    const TextureTable& table_;
    std::uint64_t unbound_reads_ = 0;
};

} // namespace traces
