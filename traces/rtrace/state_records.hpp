// Parts of the records of recorded traces that states and commands share.
#pragma once

#include "pipeline/raster_state.hpp"
#include "traces/rtrace/fields.hpp"

namespace traces::rtrace {

inline constexpr std::array<Code<pipeline::Compare>, 8> comparisons{
    {{pipeline::Compare::never, "never"},
     {pipeline::Compare::less, "less"},
     {pipeline::Compare::equal, "equal"},
     {pipeline::Compare::less_equal, "less or equal"},
     {pipeline::Compare::greater, "greater"},
     {pipeline::Compare::not_equal, "not equal"},
     {pipeline::Compare::greater_equal, "greater or equal"},
     {pipeline::Compare::always, "always"}}};

inline constexpr std::uint8_t every_channel = 15; ///< of a write mask

void visit_rectangle(Fields& fields, pipeline::PixelRectangle& rectangle);

} // namespace traces::rtrace
