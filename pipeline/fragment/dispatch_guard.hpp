// The contract of hardware that keeps conflicting quads out of the pipes: who may be dispatched while others fly.
#pragma once

#include "pipeline/fragment_stream.hpp"

#include <cstdint>

namespace pipeline {

/// One instance guards one machine; the fragment scheduler is its only user.
class DispatchGuard {
  public:
    virtual ~DispatchGuard() = default;
    /// Would dispatching these pixels of `quad` now break the guard's rule? Depends on the quad's key, on the pixels
    /// and on the quads of the same key in flight, and on nothing else.
    virtual bool blocks(const Quad& quad, std::uint8_t mask) const = 0;
    /// Quads with one key are dispatched in raster order, even when only one of them conflicts. In [0, keys()).
    virtual std::uint32_t key(const Quad& quad) const = 0;
    virtual std::uint32_t keys() const = 0;
    /// The quad enters the pipes / its stores can be seen by the next reader.
    virtual void acquire(const Quad& quad, std::uint8_t mask) = 0;
    virtual void release(const Quad& quad, std::uint8_t mask) = 0;
};

} // namespace pipeline
