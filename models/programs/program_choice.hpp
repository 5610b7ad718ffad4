// A program and how its pixels become the picture.
#pragma once

#include "pipeline/output/kbuffer.hpp"
#include "pipeline/resolve.hpp"

#include <memory>

namespace models {

struct ProgramChoice {
    std::shared_ptr<const pipeline::ModifyProgram> program;
    std::shared_ptr<const pipeline::Resolve> picture; ///< null: the entries are layers, composited front to back
};

} // namespace models
