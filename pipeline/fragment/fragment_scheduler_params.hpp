// Parameters of the fragment scheduler; the unit is in fragment_scheduler.hpp.
#pragma once

#include "sim/described.hpp"

#include <cstdint>
#include <tuple>

namespace pipeline {

struct FragmentSchedulerParams {
    std::uint32_t quads_until_store = 0;
    std::uint32_t tile = 0;

    static constexpr auto fields() {
        using P = FragmentSchedulerParams;
        return std::tuple{
            sim::field<&P::quads_until_store>("Quads between dispatch and the store of their pixels, in passes that "
                                              "update pixels; 1 = one after the other, 0 = all that fit into the pipes")
                .unit("quads")
                .range(0, 1 << 20),
            sim::field<&P::tile>("Edge of the squares of the screen whose quads all go to one pipe; 0: to any")
                .unit("pixels")
                .range(0, 64)};
    }
};
static_assert(sim::fully_described<FragmentSchedulerParams>);

} // namespace pipeline
