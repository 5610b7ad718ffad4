// Modify program `z-buffer`: the depth test of every GPU as a k-buffer of one entry.
#pragma once

#include "pipeline/output/kbuffer.hpp"

#include <memory>

namespace models {

/// One `rgbz` entry: the nearest fragment; of equal depths the first arrival (LESS).
std::shared_ptr<const pipeline::ModifyProgram> make_z_buffer();

} // namespace models
