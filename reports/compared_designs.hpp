// The hardware side of a comparison: its GPU, and the designs on it with settings of their own.
#pragma once

#include "reports/comparison.hpp"

namespace reports {

struct Hardware {
    GpuFacts gpu;
    std::vector<ComparedDesign> designs; ///< without what they submit
};

/// Reads GPU, settings and designs of a request. Throws sim::InputError with one line for an unknown name, key or
/// value, naming the design where it stands in one.
Hardware read_hardware(const ComparisonRequest& request);

/// Takes out, and names in the frame, the designs that cannot run the frame's program; ends instead where not
/// `only_able`, or where none would be left.
void check_designs(ComparisonInput& input, bool only_able);

/// Gives the tile caches of each design what is left of `bytes` on chip beside all else (0: of what the largest has);
/// takes those out that do not fit. Throws sim::InputError where none does.
void fit_to_area(ComparisonInput& input, std::uint64_t bytes);

VariantFacts facts_of(const ComparedDesign& row);

/// Makes the frames that `designs` submit themselves; those with equal wishes share one, with those of `input`, too.
void submit(const ComparisonInput& input, std::vector<ComparedDesign>& designs, const Supervision& supervision);

/// Rasterizes and shades a frame.
std::vector<pipeline::FragmentStream> shade(const pipeline::Frame& frame, unsigned threads,
                                            const Supervision& supervision);

/// Runs one design, which need not be one of the input's, on the input's frame.
pipeline::RunResult run_design(const ComparisonInput& input, const ComparedDesign& design,
                               const Supervision& supervision);

/// What run_design() would give, from the run of another design whose machine is the same on this frame.
pipeline::RunResult run_again(const ComparisonInput& input, const ComparedDesign& design,
                              const pipeline::RunResult& run);

} // namespace reports
