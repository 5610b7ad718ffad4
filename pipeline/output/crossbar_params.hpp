// Parameters of the crossbar to the ROP groups; the unit is in crossbar.hpp.
#pragma once

#include "sim/described.hpp"

#include <cstdint>
#include <tuple>

namespace pipeline {

struct CrossbarParams {
    std::uint32_t bytes_per_clk = 64;
    std::uint32_t latency = 10;
    std::uint32_t queue = 16;

    static constexpr auto fields() {
        using P = CrossbarParams;
        return std::tuple{
            sim::field<&P::bytes_per_clk>("Bytes per cycle to one ROP group").unit("bytes").range(1, 4096),
            sim::field<&P::latency>("Cycles from one side to the other, in both directions")
                .unit("cycles")
                .range(1, 1000),
            sim::field<&P::queue>("Quads that wait for the link to one ROP group").unit("quads").range(1, 4096)};
    }
};
static_assert(sim::fully_described<CrossbarParams>);

} // namespace pipeline
