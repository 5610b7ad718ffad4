// Code of a checked program for one k.
#pragma once

#include "models/programs/language/code.hpp"
#include "models/programs/language/syntax.hpp"

#include <map>
#include <string>
#include <vector>

namespace models::language {

/// Values for constants of a program, instead of those in its text; names that it does not declare are ignored.
using Overrides = std::map<std::string, float, std::less<>>;

struct CompiledProgram {
    Code make_entry; ///< locals: the shader's fields; pixel: the entry
    Code insert;     ///< locals: the entry of the fragment
    Code drain;
    std::vector<float> clear; ///< floats_per_pixel() floats
};

/// Throws sim::InputError for an index out of range and for code that grows too long.
CompiledProgram compile(const Program& program, std::uint32_t k, const Overrides& overrides);

} // namespace models::language
