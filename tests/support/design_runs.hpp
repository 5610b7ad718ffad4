// Runs that laws have to hold for: small frames, every design as it is, and variants that use other parts of the
// machine.
#pragma once

#include "tests/support/replay.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace support {

using Settings = std::vector<std::string>; ///< "rop.queue=8"

struct DesignCase {
    std::string scene;
    ReplayOptions options;
    Replay replay;

    DesignCase(std::string spec, ReplayOptions knobs)
        : scene(std::move(spec)), options(std::move(knobs)), replay(scene, options) {}
    /// Whether the design can run the frame's program.
    bool allows(const std::string& design) const;
};

/// Frames that differ in what they use: indices, draws, layers or meshes, entries, samples.
const std::vector<DesignCase>& design_cases();

/// Designs with their settings: each as it is, then the variants.
const std::vector<std::pair<std::string, Settings>>& design_variants();

/// Answers of the memory come at random times.
extern const Settings jitter;

Settings joined(Settings settings, const Settings& more);

/// A run for people.
std::string run_text(const DesignCase& one, const std::string& design, const Settings& settings);

/// check(case, design, settings) for all runs, or for one of `every` of them, spread over cases and designs.
void for_every_run(const Settings& more,
                   const std::function<void(const DesignCase&, const std::string&, const Settings&)>& check,
                   std::size_t every = 1);

} // namespace support
