// Display lists. The driver keeps what is in them, in pieces: each group of primitives and each draw is a list of its
// own, so that the state before it can be asked for when the whole is executed. Lists that are executed while they are
// compiled are executed behind that.
#pragma once

#include "traces/record_module/arrays.hpp"

#include <functional>
#include <vector>

namespace record {

/// Of the calling thread.
bool list_is_compiled();

void compile_begin(GLenum mode);
void compile_end();
/// `perform` is the driver's part.
void compile_draws(const std::vector<DrawCall>& calls, const std::function<void()>& perform);

} // namespace record
