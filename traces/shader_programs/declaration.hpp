// What the text of a modify program in GLSL says about itself: pragmas, the fields of its entries and of its state.
// README.md of traces says how such a program is written.
#pragma once

#include "pipeline/output/kbuffer.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace traces::shader_programs {

/// A float of a structure: "z", "colour.x".
using Fields = std::vector<std::string>;

enum class Picture : std::uint8_t { layers, nodes, state };

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
    bool drains = false;
    bool needs_colour = false; ///< whether some field `colour` is read, the fragment's perhaps
    std::uint32_t lines = 1;

    std::uint32_t depth_slot() const;
};

/// Throws sim::InputError "name:line: expected ..., got ...". What the language's own rules say is left to its
/// compiler.
Declaration declaration_of(std::string name, std::string text);

} // namespace traces::shader_programs
