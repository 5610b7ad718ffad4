#include "traces/loads.hpp"

#include <fmt/format.h>

namespace traces {

Load one_pane_load(const OnePaneFrame& frame) {
    return {"deferred",
            {"method=" + frame.method, "shadows=" + frame.shadows, fmt::format("refraction={}", frame.refraction),
             fmt::format("lights={}", frame.lights), fmt::format("map_size={}", frame.map_size)}};
}

} // namespace traces
