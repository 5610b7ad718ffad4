// Codes that records of more than one file have. New ones go to the end.
#pragma once

#include "pipeline/draw.hpp"
#include "traces/rtrace/fields.hpp"

namespace traces::rtrace {

inline constexpr std::array<Code<pipeline::Semantic>, pipeline::semantics> attribute_semantics{
    {{pipeline::Semantic::position, "position"},    {pipeline::Semantic::normal, "normal"},
     {pipeline::Semantic::colour, "colour"},        {pipeline::Semantic::secondary_colour, "secondary colour"},
     {pipeline::Semantic::texcoord0, "texcoord 0"}, {pipeline::Semantic::texcoord1, "texcoord 1"},
     {pipeline::Semantic::texcoord2, "texcoord 2"}, {pipeline::Semantic::texcoord3, "texcoord 3"},
     {pipeline::Semantic::texcoord4, "texcoord 4"}, {pipeline::Semantic::texcoord5, "texcoord 5"},
     {pipeline::Semantic::texcoord6, "texcoord 6"}, {pipeline::Semantic::texcoord7, "texcoord 7"},
     {pipeline::Semantic::generic, "generic"},      {pipeline::Semantic::generic1, "generic 1"},
     {pipeline::Semantic::generic2, "generic 2"},   {pipeline::Semantic::generic3, "generic 3"},
     {pipeline::Semantic::generic4, "generic 4"},   {pipeline::Semantic::generic5, "generic 5"},
     {pipeline::Semantic::generic6, "generic 6"},   {pipeline::Semantic::generic7, "generic 7"},
     {pipeline::Semantic::generic8, "generic 8"},   {pipeline::Semantic::generic9, "generic 9"},
     {pipeline::Semantic::generic10, "generic 10"}, {pipeline::Semantic::generic11, "generic 11"},
     {pipeline::Semantic::generic12, "generic 12"}, {pipeline::Semantic::generic13, "generic 13"},
     {pipeline::Semantic::generic14, "generic 14"}, {pipeline::Semantic::generic15, "generic 15"}}};
inline constexpr std::array<Code<pipeline::Wrap>, 4> wraps{{{pipeline::Wrap::repeat, "repeat"},
                                                            {pipeline::Wrap::clamp, "clamp"},
                                                            {pipeline::Wrap::mirror, "mirror"},
                                                            {pipeline::Wrap::border, "border"}}};
inline constexpr std::array<Code<pipeline::Filter>, 6> filters{
    {{pipeline::Filter::nearest, "nearest"},
     {pipeline::Filter::linear, "linear"},
     {pipeline::Filter::nearest_mip_nearest, "nearest, nearest mip"},
     {pipeline::Filter::linear_mip_nearest, "linear, nearest mip"},
     {pipeline::Filter::nearest_mip_linear, "nearest, linear mip"},
     {pipeline::Filter::linear_mip_linear, "linear, linear mip"}}};

} // namespace traces::rtrace
