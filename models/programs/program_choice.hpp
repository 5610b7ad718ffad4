// A program and how its pixels become the picture.
#pragma once

#include "models/programs/picture_shader.hpp"

#include <memory>

namespace models {

struct ProgramChoice {
    std::shared_ptr<const pipeline::ModifyProgram> program;
    MakePicture picture; ///< empty: the entries are layers, composited front to back
};

} // namespace models
