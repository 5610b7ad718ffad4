// State of processing without shaders, from what was asked of the driver.
#pragma once

#include "traces/recording/fixed_function.hpp"
#include "traces/recording/import/surfaces.hpp"

#include <vector>

namespace traces::recorded {

/// A texture of a unit, as far as the unit's work depends on it.
struct UnitTexture {
    bool there = false; ///< a unit without a texture that can be sampled does nothing
    BaseFormat format = BaseFormat::rgba;
    bool compares = false;
};

FixedFunctionState fixed_function_state_of(const record_stream::FixedFunction& fixed, const record_stream::State& state,
                                           const std::array<UnitTexture, fixed_function_units>& textures, GLenum mode);

UnitTexture unit_texture_of(const record_stream::Binding& binding, const record_stream::Surface& surface);

/// Old built-in uniforms of shaders (OpenGL Shading Language 1.20, section 7.5), by the names of their parts.
std::vector<UniformValue> built_in_uniforms(const record_stream::FixedFunction& fixed,
                                            const record_stream::State& state);

/// One of the values, as a whole.
double fixed_value(const record_stream::FixedFunction& fixed, GLenum name, std::size_t i = 0);
glm::vec4 fixed_vector(const std::vector<double>& values, std::size_t place);
glm::mat4 fixed_matrix(const std::vector<double>& values, std::size_t place);

} // namespace traces::recorded
