// Pictures of programs: layers of one opacity, colours that the program composited, nodes.
#pragma once

#include "models/programs/picture_shader.hpp"

#include <array>
#include <cstdint>
#include <memory>

namespace models {

/// Where red, green, blue (premultiplied) and transmittance lie in an entry or in a state.
using ColourSlots = std::array<std::uint32_t, 4>;

/// The entries in stored order, each of this opacity, before the background: C += T * a * c_i and T *= 1 - a. Entries
/// that still have the depth they were cleared to are empty. Four floats per entry are a colour and a depth; else the
/// layers are grey: 0.9 at the near plane to 0.1 at the far plane, linear in the logarithm of the distance
/// (perspective) or in the distance (parallel projection). Source: Bavoil 2007, section 6.1.1 (specification 004, A11).
MakePicture layers_picture(float opacity);

/// The state's colour before the background: C + T * background.
MakePicture state_picture(const ColourSlots& slots);

/// The entries' colours composited in stored order before the background.
MakePicture node_picture(const ColourSlots& slots);

/// {C, T} of the nodes of make_nodes(), sample 0, for a blend that leaves C + T * what is there.
std::shared_ptr<const pipeline::Shader> nodes_shader(std::shared_ptr<const pipeline::ModifyProgram> program);

} // namespace models
