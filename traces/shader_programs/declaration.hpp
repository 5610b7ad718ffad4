// What the text of a modify program in GLSL says about itself: pragmas, the fields of its entries and of its state.
// README.md of traces says how such a program is written.
#pragma once

#include "pipeline/output/kbuffer.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace traces::shader_programs {

/// A float of a structure: "z", "colour.x".
using Fields = std::vector<std::string>;

enum class Picture : std::uint8_t { layers, nodes, state };

/// What a program may define; `initial` where it has a state, `drain` where it wants to.
enum class Function : std::uint8_t { entry, empty, modify, initial, drain };

struct Declaration {
    std::string name; ///< of the file, for messages
    std::string text;
    std::string id, summary;
    std::uint32_t default_k = 4, least_k = 1, most_k = 64;
    Fields entry, state; ///< of the structures Entry and State; there may be no State
    std::string depth = "z";
    pipeline::OrderNeed order = pipeline::OrderNeed::primitive_order;
    pipeline::Peeling peeling = pipeline::Peeling::none;
    Picture picture = Picture::layers;
    bool needs_colour = false; ///< whether some field `colour` is read, the fragment's perhaps
    std::uint32_t lines = 1;
    std::array<std::uint32_t, 5> function_lines{}; ///< by Function; 0: it has none

    std::uint32_t depth_slot() const;
    std::uint32_t line_of(Function function) const { return function_lines[static_cast<std::size_t>(function)]; }
    bool drains() const { return line_of(Function::drain) != 0; }
    /// Of a pixel with k entries.
    std::size_t floats(std::uint32_t k) const { return k * entry.size() + state.size(); }
};

/// Throws sim::InputError "name:line: expected ..., got ...". What the language's own rules say is left to its
/// compiler.
Declaration declaration_of(std::string name, std::string text);

} // namespace traces::shader_programs
