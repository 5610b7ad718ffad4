// The full-screen passes of layered soft shadows, as the machine's time sees them: which lines each quad fetches and
// how many instructions it issues.
//
// Source: Bavoil 2007, section 5.5 (specification 004, section 2.6: passes P, B, H and K). Instructions are counted
// from the formulas of section 3.5, one per vector operation; see README.md. Left out where nothing reads them: the
// hierarchy without narrowings, the slopes without slope bias; midpoints are formed in the kernel from the packed
// depths.
#pragma once

#include "pipeline/resolve.hpp"
#include "traces/shadows/shadow_kernel.hpp"

#include <vector>

namespace traces {

/// What of a pixel's region decides its time.
struct KernelWork {
    float u = 0, v = 0, step = 1;
    std::uint16_t across = 0;
    std::uint8_t narrowings = 0;
    bool skipped = true; ///< background, or black: no light can change it
    std::array<std::uint8_t, 4> level{};
};
KernelWork kernel_work(const SearchRegion& region);

/// Surfaces and sizes that the passes share.
struct ShadowPassSetup {
    std::uint32_t width = 0, height = 0; ///< of the picture
    ShadowMapOptions map;
    ShadowKernelOptions kernel;
};

/// In order: pack, slopes, the levels of the hierarchy, kernel. `work` holds one entry per pixel of the picture.
std::vector<pipeline::ScreenPass> shadow_passes(const ShadowPassSetup& setup, const std::vector<KernelWork>& work);

/// Passes that this setup does without, by name, and the bytes that they would have moved to and from memory at least.
struct SavedPass {
    std::string name, reason;
    std::uint64_t bytes = 0;
};
std::vector<SavedPass> saved_passes(const ShadowPassSetup& setup);

} // namespace traces
