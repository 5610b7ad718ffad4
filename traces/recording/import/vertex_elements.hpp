// Elements of vertex arrays in OpenGL's types.
#pragma once

#include "pipeline/draw.hpp"
#include "traces/record_module/stream.hpp"

#include <optional>
#include <span>
#include <vector>

namespace traces::recorded {

/// The pipeline's type with the same bytes and the same meaning.
std::optional<pipeline::ComponentType> component_type_of(const record_stream::Array& array);

/// Elements in the meaning that a shader's floats have, without gaps.
std::vector<std::byte> as_floats(const record_stream::Array& array, std::span<const std::byte> bytes,
                                 std::uint64_t elements);

} // namespace traces::recorded
