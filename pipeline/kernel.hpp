// The contract of a kernel: a function over a grid of groups that reads finished surfaces and stores texels where it
// likes. For pictures that no shader can make, as the outputs of a shader go to the pixels that it is run for.
//
// Modelled: values. Not modelled: time, atomic operations, memory that a group's threads share.
#pragma once

#include "pipeline/surface_access.hpp"

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace pipeline {

/// What a pass has to provide for a kernel.
struct KernelShape {
    std::uint32_t targets = 1; ///< colour surfaces that it stores to
    std::uint32_t reads = 0;   ///< surfaces that earlier passes finished; see Pass::reads
    glm::uvec2 groups{1};      ///< columns and rows of the grid
};

/// What a group stores.
class KernelStores {
  public:
    struct Store {
        std::uint32_t target = 0; ///< its place in Pass::targets
        std::uint32_t x = 0, y = 0, plane = 0;
        glm::vec4 value{0.0F}; ///< linear colour
    };

    void store(std::uint32_t target, std::uint32_t x, std::uint32_t y, std::uint32_t plane, const glm::vec4& value) {
        all_.push_back({target, x, y, plane, value});
    }
    const std::vector<Store>& all() const { return all_; }

  private:
    std::vector<Store> all_;
};

class Kernel {
  public:
    virtual ~Kernel() = default;
    virtual KernelShape shape() const = 0;
    /// Called once for each group of the grid, in any order and by several threads; surfaces are known by their place
    /// in Pass::reads. A texel may be stored once by all groups together, so their order cannot matter.
    virtual void run(const glm::uvec2& group, SurfaceAccess& surfaces, KernelStores& stores) const = 0;
};

} // namespace pipeline
