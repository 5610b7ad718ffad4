// What glTF 2.0 says about the properties of a document, as a table: for each the type of its value, its range, and the
// list that it refers to. A property of the core or of an extension is read only if it has a row here.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace traces::gltf {

enum class Kind : std::uint8_t {
    whole,  ///< a number without a fraction, however it is written (3, 3.0, 3e0)
    number, ///< finite as a float
    flag,
    text,
    one_of, ///< one of the whole numbers in `of`
    words,  ///< one of the texts in `of`
    index,  ///< the number of an element of the list `of`
    object  ///< of the type `of`
};

/// What a value has to be; the functions below make one, its members narrow it down.
struct Shape {
    Kind kind = Kind::whole;
    std::string_view of = {};            ///< values with '|' between, a list as a JSON pointer, or a type
    double least = 0.0, most = 0.0;      ///< of numbers
    bool above = false;                  ///< `least` is not among them
    bool is_list = false;                ///< of such values
    std::size_t fewest = 0, longest = 0; ///< elements of a list
    bool is_unique = false, is_needed = false;
    bool is_unread = false; ///< nothing depends on it: a bad one is a note

    constexpr Shape list(std::size_t at_least, std::size_t at_most = std::numeric_limits<std::size_t>::max()) const {
        Shape shape = *this;
        shape.is_list = true;
        shape.fewest = at_least;
        shape.longest = at_most;
        return shape;
    }
    constexpr Shape unique() const {
        Shape shape = *this;
        shape.is_unique = true;
        return shape;
    }
    constexpr Shape needed() const {
        Shape shape = *this;
        shape.is_needed = true;
        return shape;
    }
    constexpr Shape unread() const {
        Shape shape = *this;
        shape.is_unread = true;
        return shape;
    }
};

struct Property {
    std::string_view owner; ///< type of the object that has it, "" for any
    std::string_view key;   ///< "*" for any
    Shape shape;
};

/// The rows, those of one owner next to each other. The document is an object of the type "document".
std::span<const Property> properties();

/// Extensions of which everything that matters to a frame is read.
std::span<const std::string_view> read_extensions();

} // namespace traces::gltf
