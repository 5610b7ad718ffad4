// What every geometry stage may read about the pass that is running. It changes only between runs of the event core.
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/fragment_stream.hpp"
#include "pipeline/geometry/host.hpp"

#include <span>

namespace pipeline {

struct GeometryPass {
    std::uint32_t number = 0; ///< passes started so far; 0: none
    const FragmentStream* stream = nullptr;
    const Resources* resources = nullptr;
    std::span<const Draw> draws;                 ///< what DrawRange::draw counts
    std::span<const DrawRange> ranges;           ///< those to walk; a message's `range` is an index into it
    std::span<const DrawTerms> terms = {};       ///< of each draw; empty: all as in DrawTerms{}
    std::span<const DrawTerms> range_terms = {}; ///< of each range, where parts of one draw differ; else empty

    const DrawRange& range(std::uint32_t index) const { return ranges[index]; }
    const Draw& draw(std::uint32_t range) const { return draws[ranges[range].draw]; }
    const DrawTerms& term(std::uint32_t range) const {
        static constexpr DrawTerms ordinary;
        if (!range_terms.empty()) return range_terms[range];
        return terms.empty() ? ordinary : terms[ranges[range].draw];
    }
    const Geometry& geometry(std::uint32_t range) const {
        return resources->geometries[ranges[range].is_part() ? ranges[range].geometry : draw(range).geometry];
    }
};

} // namespace pipeline
