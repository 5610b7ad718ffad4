// What derives from fields(): sums over parallel units, differences between draws, the list of all fields for help and
// the reference page, CSV columns. JSON is in described_json.hpp.
#pragma once

#include "sim/check.hpp"
#include "sim/struct_table.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace sim {

/// One field as text.
struct FieldInfo {
    std::string path; ///< "cache.lines"
    /// "whole number", "number", "true or false", "text", "choice", "counter", "high water", "histogram", "list of ..."
    std::string type;
    std::string unit;
    std::string text;
    std::string default_value;
    std::string range; ///< "1 to 65536", "at least 1", "rop_cache | writeback"; empty when anything goes
};

std::string number_text(double number); ///< shortest text that reads back as the same number
std::string number_text(float number);

/// One line of comma-separated values; cells that hold commas or quotes are quoted.
std::string csv_line(const std::vector<std::string>& cells);

namespace detail {

std::string join_path(std::string_view prefix, std::string_view name);
std::string type_name(const ValueType& type);
std::string range_text(const FieldRow& field);

void add(const StructTable& table, void* into, const void* from);
void subtract(const StructTable& table, void* from, const void* earlier);
std::vector<FieldInfo> describe(const StructTable& table, const void* defaults, std::string_view prefix);
std::vector<std::string> csv_header(const StructTable& table, const void* object, std::string_view prefix);
std::vector<std::string> csv_row(const StructTable& table, const void* object);

} // namespace detail

/// Adds up parallel units: counters and numbers are summed, high-water marks take the maximum, histograms are merged;
/// choices, flags and text stay as they are in `into`.
template <Described S>
void add(S& into, const S& from) {
    detail::add(struct_table<S>, &into, &from);
}

/// What happened between two copies of one struct: counters, numbers and histograms are subtracted; a high-water mark,
/// like every other field, is that of `later`.
template <Described S>
S difference(const S& later, const S& earlier) {
    S between = later;
    detail::subtract(struct_table<S>, &between, &earlier);
    return between;
}

/// All fields of S and of the structs in it, with their defaults.
template <Described S>
std::vector<FieldInfo> describe(std::string_view prefix = {}) {
    const S defaults{};
    return detail::describe(struct_table<S>, &defaults, prefix);
}

/// Column titles, with units: "tile_cache.hits [lines]". A histogram has four columns, a vector one.
template <Described S>
std::vector<std::string> csv_header(std::string_view prefix = {}) {
    const S defaults{};
    return detail::csv_header(struct_table<S>, &defaults, prefix);
}

/// The cells below csv_header().
template <Described S>
std::vector<std::string> csv_row(const S& object) {
    return detail::csv_row(struct_table<S>, &object);
}

} // namespace sim
