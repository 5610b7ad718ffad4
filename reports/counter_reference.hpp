// What every counter of a run means, by the stage that has it.
#pragma once

#include "sim/described.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace reports {

struct StageReference {
    std::string_view stage; ///< as in result.json
    std::string_view text;  ///< which unit it is
    std::vector<sim::FieldInfo> counters;
};

/// All stages that a machine can have, from the draw call to memory.
const std::vector<StageReference>& stage_reference();

/// The counter that a leaf of result.json belongs to ("l1.kbuffer_hits", "bytes.3", "occupancy.mean"), or null.
const sim::FieldInfo* find_counter(std::string_view stage, std::string_view path);

/// `path` with the elements of arrays named: "bytes.3" of the memory partitions -> "bytes.kbuffer_read".
std::string counter_name(std::string_view stage, std::string_view path);

} // namespace reports
