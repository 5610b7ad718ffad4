// A program in the k-buffer language as a tree. The parser builds it; the checker finds out what its names mean.
#pragma once

#include "models/programs/language/lexer.hpp"
#include "pipeline/output/kbuffer.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace models::language {

enum class Type : std::uint8_t { number, integer, boolean, entry };

enum class Operation : std::uint8_t {
    negate,
    invert, // one operand
    add,
    subtract,
    multiply,
    divide,
    less,
    less_or_equal,
    greater,
    greater_or_equal,
    equal,
    not_equal,
    both,
    either,
    least,
    greatest, // two
    magnitude,
    truncate, // one, written as functions
    choose    // three
};

/// What a name or an object of the text stands for.
enum class Meaning : std::uint8_t {
    unknown,
    constant, ///< slot: index into Program::constants
    entries,  ///< k: how many entries a pixel has
    largest,  ///< the largest float
    counter,  ///< variable of a loop; slot counts the loops of the program
    variable, ///< slot counts the variables of the program
    of_entry, ///< e[index] or e[index].field; slot: the field
    fragment, ///< f or f.field; slot: the field, as the entry's, or as the shader's in `entry` and nowhere else
    of_state  ///< s.field
};

struct Expression {
    enum class Kind : std::uint8_t { literal, operation, reference };

    Place place;
    Kind kind = Kind::literal;
    double value = 0.0; ///< of a literal; 0 or 1 when boolean
    Operation operation = Operation::add;
    std::string name;                 ///< of a reference: "e", "f", "s" or a name
    std::string field;                ///< behind the dot; empty: none
    std::vector<Expression> operands; ///< of an operation; of a reference to e, its index
    std::uint32_t depth = 1;          ///< longest way down to a leaf

    // By the checker.
    Type type = Type::number;
    Meaning meaning = Meaning::unknown;
    std::uint32_t slot = 0;
    bool constant = false; ///< known when k is
};

struct Statement {
    enum class Kind : std::uint8_t { declare, assign, swap, branch, loop };

    Place place;
    Kind kind = Kind::assign;
    Type type = Type::number; ///< of a declared variable
    std::string name;         ///< of a declared variable or of a loop's
    /// The value; target and value; two targets; the condition; first and end.
    std::vector<Expression> operands;
    std::vector<Statement> body, otherwise;
    std::uint32_t slot = 0; ///< by the checker
};

/// A name with an expression: a field of the entry or state, a constant.
struct Definition {
    Place place;
    std::string name;
    Expression value;
};

enum class Picture : std::uint8_t { layers, nodes, state };

struct Program {
    explicit Program(Source text) : source(std::move(text)) {}

    Source source;
    std::string id, summary;
    std::uint32_t default_k = 4, least_k = 1, most_k = 64;
    std::vector<Definition> entry;     ///< how a shaded fragment becomes an entry
    std::vector<Definition> empty;     ///< of an entry without fragment; fields that are not named are 0
    std::vector<Definition> state;     ///< with the initial value
    std::vector<Definition> constants; ///< each may use those before it
    std::string depth = "z";           ///< the entry's field that is its depth
    Place depth_place;
    pipeline::OrderNeed order = pipeline::OrderNeed::primitive_order;
    pipeline::Peeling peeling = pipeline::Peeling::none;
    Picture picture = Picture::layers;
    Place picture_place;
    std::vector<Statement> fragment, drain;
    bool has_drain = false;

    // By the checker.
    std::uint32_t depth_slot = 0;
    std::uint32_t variables = 0, counters = 0;
    bool needs_colour = false;
};

/// The fields of a shaded fragment, in the order of their slots.
inline constexpr std::string_view shader_fields[] = {"r", "g", "b", "a", "z", "object"};

} // namespace models::language
