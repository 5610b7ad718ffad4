// The modify programs by name.
#pragma once

#include "pipeline/output/kbuffer.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace models {

struct Program {
    std::string id;
    std::string summary;
    std::vector<std::string> entries; ///< kinds of entry it can keep: "rgbz", "z"
};

/// All programs, in the order in which help lists them.
const std::vector<Program>& programs();

/// Program `id` with k (1 to 64) entries of kind `entry`. Throws sim::InputError, naming what is near to a mistyped
/// name.
std::shared_ptr<const pipeline::ModifyProgram> make_program(std::string_view id, std::string_view entry,
                                                            std::uint32_t k);

} // namespace models
