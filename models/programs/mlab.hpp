// Modify program `mlab`, multi-layer alpha blending (Salvi and Vaidyanathan 2014): the nearest fragments in nodes of
// their own; what overflows is composited into the last node, so that no fragment is lost, only its place.
#pragma once

#include "pipeline/output/kbuffer.hpp"

#include <cstdint>
#include <memory>

namespace models {

/// Nodes a pixel can have: five floats each in at most 64 render targets.
inline constexpr std::uint32_t most_mlab_nodes = 51;

/// Entries: red, green and blue premultiplied, transmittance, depth. Of equal depths the first arrival is in front.
/// @param k       nodes, 1 to most_mlab_nodes
/// @param opacity of every fragment, 0 to 1
std::shared_ptr<const pipeline::ModifyProgram> make_mlab(std::uint32_t k, float opacity);

/// The same of fragments that are nodes already: their colour weighted, the share that they let through for an alpha.
/// Of equal depths the last arrival is in front, as where it is blended: letters over the panel that they are written
/// on.
std::shared_ptr<const pipeline::ModifyProgram> make_nodes(std::uint32_t k);

} // namespace models
