// The computer around the GPU: the driver, the bus, and what they make of a draw before the hardware sees it.
//
// Modelled, each by a number of its own that is off by default: the time a frame costs apart from its draws; conversion
// of vertex formats that the hardware does not know; the slow path of draws whose index range is large, with three
// explanations to choose from; the gain of draws with a small index range; buffers that do not fit into video memory;
// vertices that come from the application with every frame instead of from buffers. These are properties of drivers,
// measured from outside; why they are so is not modelled. Not modelled: the latency of the bus, contention on it.
//
// Buffers are replaced whole, the least recently used one first. A frame goes round its buffers in a circle, so when
// they do not fit together, every one has been replaced before it is needed again: all of them cross the bus in every
// pass, each before the first draw that reads it. The copies are commands among the draws, so the GPU does not draw
// meanwhile. Source: specification 004, sections 2.1, 4.1-4.6, 5 (verdicts P and C; mechanisms M1-M3), 9.1.
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/fragment_stream.hpp"
#include "pipeline/frame.hpp"
#include "sim/described.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace pipeline {

/// Why a large indexed draw is slow (specification 004, section 5).
enum class RangeCliff : std::uint8_t {
    none,
    index_range,    ///< M1: the index range of the draw exceeds what the driver takes for one call
    cache_capacity, ///< M2: the vertices of the draw exceed a cache that the GPU walks through in circles
    host_memory     ///< M3: the driver leaves an over-large buffer in the memory of the computer
};

} // namespace pipeline

template <>
struct sim::EnumNames<pipeline::RangeCliff> {
    static constexpr std::array<std::string_view, 4> names{"none", "index_range", "cache_capacity", "host_memory"};
};
template <>
struct sim::EnumNames<pipeline::Submission> {
    static constexpr std::array<std::string_view, 4> names{"buffers", "client_arrays", "immediate", "display_list"};
};

namespace pipeline {

/// What the driver takes for a vertex with an attribute of a format, by component type: the conversion of formats that
/// the hardware does not know, and what else makes a slot slow.
struct SlotConversion {
    double f32_ns = 0, f16_ns = 0, s8_ns = 0, u8_ns = 0, s16_ns = 0, u16_ns = 0, packed_ns = 0;

    double ns(ComponentType type) const;

    static constexpr auto fields() {
        using P = SlotConversion;
        constexpr auto of = [](auto field) { return field.unit("ns/vertex").range(0, 1e6); };
        return std::tuple{
            of(sim::field<&P::f32_ns>("From 32-bit floats")), of(sim::field<&P::f16_ns>("From 16-bit floats")),
            of(sim::field<&P::s8_ns>("From signed bytes")),   of(sim::field<&P::u8_ns>("From unsigned bytes")),
            of(sim::field<&P::s16_ns>("From signed shorts")), of(sim::field<&P::u16_ns>("From unsigned shorts")),
            of(sim::field<&P::packed_ns>("From 10-10-10-2"))};
    }
};
static_assert(sim::fully_described<SlotConversion>);

struct ConversionParams {
    SlotConversion position, normal, colour, texcoord, generic;

    const SlotConversion& of(Slot slot) const;

    static constexpr auto fields() {
        using P = ConversionParams;
        return std::tuple{sim::field<&P::position>("Positions"), sim::field<&P::normal>("Normals"),
                          sim::field<&P::colour>("Colours"), sim::field<&P::texcoord>("Texture coordinates"),
                          sim::field<&P::generic>("Generic attributes")};
    }
};
static_assert(sim::fully_described<ConversionParams>);

struct HostParams {
    double frame_us = 0;
    RangeCliff range_cliff = RangeCliff::none;
    std::uint32_t range_limit_vertices = 1U << 20U;
    double overflow_slowdown = 1;
    double range_limit_mb = 12;
    double span_slowdown = 0;
    std::uint32_t span_saturation = 1000;
    double vram_mb = 0;
    double bus_gbps = 4;
    double outside_gbps = 4;
    double client_gbps = 4;
    double immediate_ns = 0;
    double list_ns = 0;
    ConversionParams convert;

    static constexpr auto fields() {
        using P = HostParams;
        return std::tuple{
            sim::field<&P::frame_us>("CPU time of a frame apart from its draw calls").unit("us").range(0, 1e6),
            sim::field<&P::range_cliff>("Why large indexed draws are slow"),
            sim::field<&P::range_limit_vertices>("Largest index range that is not slow (index_range)")
                .unit("vertices")
                .at_least(1),
            sim::field<&P::overflow_slowdown>("Vertex input of a slow draw takes so many times as long "
                                              "(index_range, cache_capacity)")
                .range(1, 1000),
            sim::field<&P::range_limit_mb>("Most bytes of vertices that are not slow (cache_capacity, host_memory)")
                .unit("MB")
                .range(0.001, 1e6),
            sim::field<&P::span_slowdown>("Vertex input of a draw takes so much longer with the largest fast index "
                                          "range than with the smallest; grows with the logarithm of the range")
                .range(0, 100),
            sim::field<&P::span_saturation>("Index range below which nothing is gained").unit("vertices").at_least(1),
            sim::field<&P::vram_mb>(
                "Video memory for vertices and indices; buffers of a frame that exceed it cross the "
                "bus in every pass; 0: enough")
                .unit("MB")
                .range(0, 1e6),
            sim::field<&P::bus_gbps>("Bus between computer and GPU").unit("GB/s").range(0.001, 1e4),
            sim::field<&P::outside_gbps>("What comes from outside video memory; the bus is another limit")
                .unit("GB/s")
                .range(0.001, 1e4),
            sim::field<&P::client_gbps>("What the driver copies of arrays that the application keeps; the bus is "
                                        "another limit")
                .unit("GB/s")
                .range(0.001, 1e4),
            sim::field<&P::immediate_ns>("A vertex in immediate mode; 0: the bus only").unit("ns").range(0, 1e6),
            sim::field<&P::list_ns>("A vertex in a display list; 0: as from buffers").unit("ns").range(0, 1e6),
            sim::field<&P::convert>("Conversion of vertex formats by the driver")};
    }
};
static_assert(sim::fully_described<HostParams>);

/// What computer and driver make of one draw call.
struct DrawTerms {
    std::uint32_t span = 0;  ///< vertices from the lowest to the highest index
    double cpu_us = 0;       ///< before the draw can be submitted: conversion
    double slowdown = 1;     ///< of the vertex input, at least 1
    double host_share = 0;   ///< of the bytes of vertices and indices: they are fetched across the bus
    double copied_bytes = 0; ///< of buffers that are brought into video memory before the draw
    double feed_us = 0;      ///< what it takes to hand the vertices over; the GPU works meanwhile. 0: from buffers
    bool over_limit = false; ///< one of the explanations of large draws applies
};

/// Terms of every draw of the frame, by draw. Draws that share a geometry and a material's needs cost the same.
std::vector<DrawTerms> draw_terms(const HostParams& params, const Frame& frame);
/// Of every range of a pass that consists of parts of draws; empty where those of their draws do.
std::vector<DrawTerms> range_terms(const HostParams& params, const Frame& frame, std::span<const DrawRange> ranges);

/// Seconds in which `bytes` cross the bus.
inline double bus_seconds(const HostParams& params, double bytes) { return bytes / (params.bus_gbps * 1e9); }
/// Seconds in which `bytes` come from outside video memory.
inline double outside_seconds(const HostParams& params, double bytes) {
    return bytes / (std::min(params.bus_gbps, params.outside_gbps) * 1e9);
}

} // namespace pipeline
