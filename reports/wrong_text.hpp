// Why pixels are wrong, in words; for tables, terminal and page.
#pragma once

#include "reports/comparison_result.hpp"
#include "sim/described.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace reports {

/// Calls visit(name, explanation, pixels) for every reason there may be.
template <class Visit>
void for_each_reason(const pipeline::WrongBecause& because, Visit&& visit) {
    sim::for_each_field(
        because, [&visit](const auto& field, const std::uint64_t& pixels) { visit(field.name, field.text, pixels); });
}

/// Of each design with wrong pixels one line: "multipass: 64 wrong pixels: in 64 layers lie ...". Hazards are told by
/// tables of their own: a design whose wrong pixels all have one is not listed.
std::vector<std::string> wrong_lines(const Comparison& comparison);

} // namespace reports
