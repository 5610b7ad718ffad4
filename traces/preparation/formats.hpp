// Attributes in other number formats.
#pragma once

#include "traces/preparation/triangle_mesh.hpp"

#include <glm/vec4.hpp>
#include <vector>

namespace traces {

/// The elements as the vertex shader reads them.
std::vector<glm::vec4> values_of(const Column& column);

/// Values as floats, or as 8 or 16 bit integers: rounded to nearest (halves away from zero) and clamped to what the
/// format holds, normalised or not; no number becomes 0. `format` says type, components and whether normalised.
Column column_from(const pipeline::VertexAttribute& format, const std::vector<glm::vec4>& values);

/// The same semantic in another format.
pipeline::VertexAttribute with_format(pipeline::VertexAttribute attribute, pipeline::ComponentType type,
                                      std::uint8_t components, bool normalized);

} // namespace traces
