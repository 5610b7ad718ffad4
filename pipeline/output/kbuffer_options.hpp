// The choices that the plan of a k-buffer design is made of, with their names; see kbuffer_design.hpp.
#pragma once

#include "sim/described.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace pipeline {

/// Where the program runs.
enum class UpdateSite : std::uint8_t {
    fragment_shader, ///< the shader reads the pixel as a texture and stores all entries
    blender,         ///< a unit in the ROP reads, modifies and writes
    passes,          ///< nowhere: geometry passes with fixed-function tests
    lists,           ///< in a pass behind the geometry, which only keeps all fragments
};

/// When a store becomes visible to a texture read.
enum class Visibility : std::uint8_t { rop_cache, writeback, never_until_flush };
/// What drops stale k-buffer lines from the texture caches.
enum class TextureCoherence : std::uint8_t { none, invalidate_on_draw, invalidate_on_write };
enum class DispatchPolicy : std::uint8_t { any_pipe, tile_affinity };
/// Order in which quads leave the fragment stage.
enum class Retirement : std::uint8_t { in_order, out_of_order };
/// Who may be inside the part of a shader that reads, modifies and stores a pixel.
enum class CriticalSection : std::uint8_t {
    none,
    ordered,   ///< one quad at a time, in the order of the primitives
    unordered, ///< one quad at a time, whoever comes first
};
/// What is locked for one critical section, or tested by an interlock in the ROP.
enum class LockArea : std::uint8_t {
    pixel, ///< the living pixels of the quad
    quad,  ///< its 2x2 block
    tile,  ///< the 4x4 tile that it lies in
};
/// What a unit of the ROP does with a fragment.
enum class BlendUnit : std::uint8_t {
    program,    ///< runs the modify program
    peel,       ///< compares with all depths at once and shifts: nearest-k only
    atomic_min, ///< one atomic minimum after the other, each with what the one before displaced
};
/// How the ROP finds out that a quad's pixel is inside its unit.
enum class InterlockTest : std::uint8_t {
    exact,  ///< compares with every quad inside (associative memory)
    hashed, ///< counters by a hash of the pixel
    tile,   ///< a ticket per 4x4 tile: its next quad waits for all quads of the tile inside
};
/// What a fragment is compared with before it is shaded, to be dropped when no entry can take it.
enum class EarlyReject : std::uint8_t {
    none,
    tile,  ///< the farthest last entry of its 4x4 tile
    pixel, ///< the last entry of its pixel
};
/// What a unit of the ROP does with a quad whose pixel is inside its pipeline.
enum class BlendInterlock : std::uint8_t {
    stall,   ///< waits until the older result is written
    forward, ///< takes the older result from the pipeline's end
    none,    ///< reads the stale value (hazards)
};
/// How a peeling pass tells the layers it has already captured.
enum class PeelRule : std::uint8_t {
    exact, ///< by depth, then by submission order: no layer is lost or repeated
    eps,   ///< by depth + eps (specification A10)
};
/// What one geometry pass captures of each pixel.
enum class PassCapture : std::uint8_t {
    nearest,          ///< the nearest fragment behind the layer before
    nearest_farthest, ///< and the farthest before the one captured from behind: two layers a pass
    range,            ///< the nearest fragment of a range of depths
};
/// How a later pass puts the fragments of a pixel into its entries.
enum class ListSort : std::uint8_t {
    full,    ///< all are sorted by depth in an array; the modify program runs over the sorted ones
    entries, ///< the modify program runs over them as they are found
};
/// How often the counter is asked that gives out the lists' memory.
enum class ListCounter : std::uint8_t {
    quad,     ///< once for the fragments of a quad together
    fragment, ///< once for each
};

} // namespace pipeline

template <>
struct sim::EnumNames<pipeline::Visibility> {
    static constexpr std::array<std::string_view, 3> names{"rop_cache", "writeback", "never_until_flush"};
};
template <>
struct sim::EnumNames<pipeline::TextureCoherence> {
    static constexpr std::array<std::string_view, 3> names{"none", "invalidate_on_draw", "invalidate_on_write"};
};
template <>
struct sim::EnumNames<pipeline::DispatchPolicy> {
    static constexpr std::array<std::string_view, 2> names{"any_pipe", "tile_affinity"};
};
template <>
struct sim::EnumNames<pipeline::BlendInterlock> {
    static constexpr std::array<std::string_view, 3> names{"stall", "forward", "none"};
};
template <>
struct sim::EnumNames<pipeline::ListSort> {
    static constexpr std::array<std::string_view, 2> names{"full", "entries"};
};
template <>
struct sim::EnumNames<pipeline::ListCounter> {
    static constexpr std::array<std::string_view, 2> names{"quad", "fragment"};
};
template <>
struct sim::EnumNames<pipeline::Retirement> {
    static constexpr std::array<std::string_view, 2> names{"in_order", "out_of_order"};
};
template <>
struct sim::EnumNames<pipeline::LockArea> {
    static constexpr std::array<std::string_view, 3> names{"pixel", "quad", "tile"};
};
template <>
struct sim::EnumNames<pipeline::EarlyReject> {
    static constexpr std::array<std::string_view, 3> names{"none", "tile", "pixel"};
};
template <>
struct sim::EnumNames<pipeline::PeelRule> {
    static constexpr std::array<std::string_view, 2> names{"exact", "eps"};
};
