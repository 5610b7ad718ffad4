// Display lists, as far as they hold draws.
#pragma once

#include "tests/replay_oracle/measure_mesa/measurement.hpp"

namespace measure {

bool list_is_compiled();
/// To the list that is compiled.
void add_to_list(const std::vector<SubmittedDraw>& draws);

} // namespace measure
