// The alpha tests of a scene at any point of its triangles, for occlusion.
#pragma once

#include "pipeline/draw.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace reports {

class AlphaMasks {
  public:
    /// Both outlive it.
    AlphaMasks(const pipeline::Resources& resources, const std::vector<pipeline::Draw>& draws);
    ~AlphaMasks();
    AlphaMasks(const AlphaMasks&) = delete;
    AlphaMasks& operator=(const AlphaMasks&) = delete;

    /// Meshes count the instances of all draws in order. False: all of it stands.
    bool masked(std::size_t mesh) const { return masks_[mesh] != nullptr; }

    /// What the fragment shader would say of a fragment there, its texture read in the finest level. Never throws.
    bool stands(std::uint32_t mesh, std::uint32_t triangle, float u, float v) const;

  private:
    struct Mask;
    std::vector<std::shared_ptr<const Mask>> masks_; ///< by mesh; instances share
};

} // namespace reports
