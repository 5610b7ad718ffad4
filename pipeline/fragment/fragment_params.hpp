// Parameters of a fragment pipeline and of its texture unit; the units are in fragment_pipeline.hpp and
// texture_cache.hpp.
#pragma once

#include "sim/described.hpp"

#include <cstdint>
#include <tuple>

namespace pipeline {

struct FragmentParams {
    std::uint32_t pipes = 6;
    std::uint32_t quads_in_flight = 256;
    std::uint32_t alu_per_clk = 2;
    std::uint32_t latency = 30;
    std::uint32_t registers = 4096;

    static constexpr auto fields() {
        using P = FragmentParams;
        return std::tuple{
            sim::field<&P::pipes>("Quad pipelines, four fragments wide (P)").unit("pipes").range(1, 64),
            sim::field<&P::quads_in_flight>("Quads in flight per pipe (W)").unit("quads").range(1, 4096),
            sim::field<&P::alu_per_clk>("Vector instructions issued per cycle for a quad")
                .unit("instructions")
                .range(1, 64),
            sim::field<&P::latency>(
                "Cycles through an empty pipe, without texture reads; a shader that issues for n cycles adds n - 1")
                .unit("cycles")
                .range(1, 10000),
            sim::field<&P::registers>("128-bit registers per fragment lane, shared by the quads in flight")
                .unit("registers")
                .range(1, 1 << 20)};
    }
};
static_assert(sim::fully_described<FragmentParams>);

struct TextureParams {
    std::uint32_t l1_bytes = 4096;
    std::uint32_t l1_ways = 4;
    std::uint32_t hit_latency = 40;
    std::uint32_t cycles_per_fetch = 1;
    std::uint32_t cycles_per_rgba32f = 4;

    static constexpr std::uint32_t line_bytes = 64; ///< 4x4 RGBA8 texels, or one 2x2 block of an RGBA32F target

    static constexpr auto fields() {
        using P = TextureParams;
        return std::tuple{sim::field<&P::l1_bytes>("Texture L1 cache of one pipe, in lines of 64 bytes; 0 = none")
                              .unit("bytes")
                              .range(0, 1 << 28),
                          sim::field<&P::l1_ways>("Ways of the texture L1 cache").unit("ways").range(1, 64),
                          sim::field<&P::hit_latency>("From lookup to filtered value, when the line is in L1")
                              .unit("cycles")
                              .range(1, 10000),
                          sim::field<&P::cycles_per_fetch>("Texture unit time of one RGBA8 or depth fetch of a quad")
                              .unit("cycles")
                              .range(1, 64),
                          sim::field<&P::cycles_per_rgba32f>("Texture unit time of one RGBA32F fetch of a quad")
                              .unit("cycles")
                              .range(1, 64)};
    }
};
static_assert(sim::fully_described<TextureParams>);

} // namespace pipeline
