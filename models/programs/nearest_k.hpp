// Modify program A6, nearest-k: the k fragments nearest to the eye, sorted (Bavoil 2007, section 4.4).
//
// One bubble pass: from the first entry on, the fragment and the entry are exchanged where the fragment is nearer; what
// is left over is dropped. Of equal depths the first arrival wins: the arriving fragment is compared with <, an entry
// that it displaced with <=, since that one came before the entries behind it. On sorted entries the outcome is the k
// smallest depths seen, whatever the order of arrival. Entries that a torn read left unsorted go through the same pass.
#pragma once

#include "pipeline/output/kbuffer.hpp"
#include "sim/field.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string_view>

namespace models {

/// What an entry holds: R, G, B and depth (one render target each), the depth alone (four in one render target), depth
/// and object, which is the number of the draw (two in one render target), or those two and R.
enum class EntryKind : std::uint8_t { rgbz, z, zo, zor };

/// Depth of an empty entry: farther than every window depth, and finite, so that differences of entries stay numbers.
inline constexpr float empty_depth = std::numeric_limits<float>::max();

/// @param k entries, 1 to 64
std::shared_ptr<const pipeline::ModifyProgram> make_nearest_k(EntryKind entry, std::uint32_t k);

} // namespace models

template <>
struct sim::EnumNames<models::EntryKind> {
    static constexpr std::array<std::string_view, 4> names{"rgbz", "z", "zo", "zor"};
};
