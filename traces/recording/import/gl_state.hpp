// Words of OpenGL as those of the pipeline.
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/raster_state.hpp"
#include "traces/record_module/fixed_state_names.hpp"
#include "traces/record_module/stream.hpp"
#include "traces/recording/recording.hpp"

#include <functional>
#include <string>

namespace traces::recorded {

/// Told of what a recording cannot have.
using Count = std::function<void(const std::string&)>;

double value_in(const record_stream::State& state, GLenum name, std::size_t i = 0);
bool is_on(const record_stream::State& state, GLenum name);

pipeline::Compare compare_of(std::uint32_t name);
RecordedSampler sampler_of(const record_stream::Sampler& sampler, bool seamless);

struct StateContext {
    std::uint32_t height = 0;   ///< of the targets
    bool top_row_first = false; ///< rows are turned over
    GLenum mode = 0;            ///< of the draw
};

pipeline::PixelRectangle rectangle_of(const record_stream::State& state, GLenum name, const StateContext& context);
pipeline::RasterState raster_state_of(const record_stream::State& state, const StateContext& context,
                                      const Count& count);

} // namespace traces::recorded
