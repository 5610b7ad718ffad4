// The modify programs by name.
#pragma once

#include "models/programs/program_choice.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace models {

/// What of a program can be chosen where programs are chosen by name. Programs that need more (bounds, iso-values, a
/// transfer function) get an even partition of [0,1], the middle of it, and a grey ramp; their makers take the rest.
struct ProgramOptions {
    std::string entry; ///< kind of entry; empty: the program's first
    std::uint32_t k = 4;
    float opacity = 0.5F; ///< of every fragment, where the program composites
};

struct Program {
    std::string id;
    std::string summary;
    std::vector<std::string>
        entries; ///< kinds of entry it can keep: "rgbz" (colour, depth), "z", "zo" (depth, draw)...
    std::uint32_t most_k = 64;
    ProgramChoice (*make)(const ProgramOptions& options);
};

/// All programs, in the order in which help lists them.
const std::vector<Program>& programs();

/// The program of that name, or of that file when the name ends in ".kb" (see language/). A file is looked for as it
/// stands and then in the data folder models/programs. Throws sim::InputError, naming what is near to a mistyped name.
ProgramChoice choose_program(std::string_view name, const ProgramOptions& options);

/// Program `id` with k entries of kind `entry`.
std::shared_ptr<const pipeline::ModifyProgram> make_program(std::string_view id, std::string_view entry,
                                                            std::uint32_t k);

} // namespace models
