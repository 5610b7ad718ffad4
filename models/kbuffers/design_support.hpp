// What a design can be used for: which programs, which antialiasing, whether fragments can be rejected early.
#pragma once

#include "pipeline/output/kbuffer_design.hpp"

#include <nlohmann/json_fwd.hpp>

namespace models {

/// { "programs": names with the kinds of entry, "antialiasing": "per sample" or "supersampling", "early_reject":
/// whether fragments that no entry can take are dropped before shading }. For antialiasing see
/// KBufferPlan::works_per_sample().
nlohmann::ordered_json support_of(const pipeline::KBufferDesign& design);

} // namespace models
