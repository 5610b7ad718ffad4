// What travels between the fragment units.
#pragma once

#include "pipeline/fragment_stream.hpp"
#include "sim/time.hpp"

#include <array>
#include <bit>
#include <cstdint>

namespace pipeline {

enum class QuadKind : std::uint8_t {
    quad,
    writeback,  ///< in-band command to every ROP: make all dirty tiles observable
    invalidate, ///< in-band command to every pipe: drop the texture cache's k-buffer lines
};

inline constexpr std::uint32_t no_slot = ~std::uint32_t{0};

/// The pixels of which a mask of sample quads, four bits each, holds any sample.
constexpr std::uint8_t pixels_of(std::uint32_t mask) {
    mask |= mask >> 16U;
    mask |= mask >> 8U;
    return static_cast<std::uint8_t>((mask | mask >> 4U) & 15U);
}

/// A quad on its way from the rasterizer to its ROP; in a multisampled pass a group of sample quads.
struct QuadTask {
    QuadId quad = 0;              ///< the first of its group
    std::uint32_t slot = no_slot; ///< in QuadPayloads, when the shader reads the k-buffer
    std::uint32_t sequence = 0;   ///< place in the reorder buffer's order
    std::uint32_t mask = 0;       ///< what is still alive: bit 4 * n + i is pixel i of sample quad `quad` + n
    QuadKind kind = QuadKind::quad;
    std::uint16_t pipe = 0;
    std::array<std::uint32_t, 4> order{}; ///< per pixel: predecessors at that pixel in raster order
    std::uint32_t ticket = 0;             ///< predecessors in the quad's lock area, where locks are coarser than pixels
    sim::Cycle retired = 0;               ///< core cycle the reorder buffer let it go

    /// Pixels of which any sample is alive.
    std::uint8_t pixels() const { return pixels_of(mask); }
};

/// Those samples of a task for which keep(sample quad, pixel) holds.
template <class Keep>
std::uint32_t kept_samples(const QuadTask& task, Keep&& keep) {
    std::uint32_t mask = 0;
    for (std::uint32_t left = task.mask; left != 0; left &= left - 1) {
        const auto bit = static_cast<std::uint32_t>(std::countr_zero(left));
        if (keep(task.quad + bit / 4, bit % 4)) mask |= left & -left;
    }
    return mask;
}

/// A pipe finished the shader of a quad.
struct Completion {
    std::uint32_t sequence = 0;
    std::uint32_t mask = 0; ///< what survived the shader, as in the task
};

/// A pipe asks for k-buffer lines of one 2x2 block; the values go into the quad's payload slot.
struct KBufferRead {
    std::uint32_t block = 0;
    std::uint32_t slot = 0;
    std::uint64_t targets = 0; ///< bit t: render target t is wanted
    std::uint32_t draw = 0;
    std::uint16_t pipe = 0;
    std::uint16_t thread = 0; ///< comes back in the answer
    std::uint8_t pixels = 15; ///< mask of those that are wanted: all where they fill a line of the L1
};

struct KBufferReadDone {
    std::uint16_t thread = 0;
};

/// A quad wants to enter its critical section; the lock table answers with a grant.
struct LockRequest {
    QuadId quad = 0;
    std::uint8_t mask = 0;
    std::uint16_t thread = 0; ///< comes back in the grant
    std::array<std::uint32_t, 4> order{};
    std::uint32_t ticket = 0;
};

struct LockGrant {
    std::uint16_t thread = 0;
};

/// No entry of these pixels can take a fragment at this depth or behind it any more.
struct LastEntryBound {
    std::uint32_t block = 0; ///< 2x2 block, or its tile when `whole_tile`
    std::uint8_t pixel = 0;
    bool whole_tile = false;
    float depth = 0;
};

/// A ROP applied the store of a quad (or finished a write-back command).
struct Commit {
    std::uint32_t slot = no_slot;
    QuadId quad = 0;
    std::uint8_t mask = 0;
    QuadKind kind = QuadKind::quad;
};

/// A store to this block became observable; sent to texture caches that are kept coherent.
struct LineInvalidation {
    std::uint32_t block = 0;
};

} // namespace pipeline
