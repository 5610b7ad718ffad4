// Frames that measurements ask for by what they load, whichever workload draws them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace traces {

struct Load {
    std::string workload;
    std::vector<std::string> settings = {}; ///< "key=value"
};

/// Every vertex once through the geometry feed, with all its attributes or its position alone (specification 004, W1).
Load geometry_feed_load(bool every_attribute);

/// The k nearest entries of each pixel, of a kind (W2; by passes W3).
Load layers_load(std::uint32_t k, const std::string& entry);

/// The nearest surface of each pixel, with a depth buffer and no k-buffer.
Load nearest_surface_load();

/// Every fragment blended by the fixed-function ROP, into a colour format.
Load blending_load(const std::string& colour_format);

/// One transparent layer over what lies behind it, in the light of spot lights (specification 003).
struct OnePaneFrame {
    std::string method;  ///< "pm", "dp", "fwd", "fw"
    std::string shadows; ///< "none", "opaque", "transparent"
    bool refraction = true;
    std::uint32_t lights = 0;
    std::uint32_t map_size = 1024; ///< texels
};
Load one_pane_load(const OnePaneFrame& frame);

/// Programs over the samples of a scalar field along each pixel's ray: an integral (A16), crossings of iso-values
/// (A15).
Load ray_integral_load();
Load crossings_load();

} // namespace traces
