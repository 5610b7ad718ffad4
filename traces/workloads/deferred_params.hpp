// The parameters of workload deferred.
#pragma once

#include "sim/described.hpp"
#include "traces/deferred/shaders.hpp"
#include "traces/deferred/truth.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

namespace traces {

enum class DeferredMethod : std::uint8_t { pm, dp, fwd, fw, kg };

} // namespace traces

template <>
struct sim::EnumNames<traces::DeferredMethod> {
    static constexpr std::array<std::string_view, 5> names{"pm", "dp", "fwd", "fw", "kg"};
};

namespace traces {

struct DeferredParams {
    DeferredMethod method = DeferredMethod::pm;
    std::uint32_t lights = 4;
    Shadows shadows = Shadows::transparent;
    ShadowMaps shadow_maps = ShadowMaps::rows;
    bool refraction = true;
    double refraction_coefficient = 0.03;
    std::uint32_t map_size = 1024;
    double bias = 1e-3;
    float slope_bias = 2.0F;
    double intensity = 1.0;
    float ambient = 0.1F;
    float specular = 0.3F;
    float specular_power = 32.0F;
    bool maps = true;
    bool lit_once = false;
    TruthFilter truth_filter = TruthFilter::nearest;

    static constexpr auto fields() {
        using P = DeferredParams;
        return std::tuple(
            sim::field<&P::method>(
                "pm: one G-buffer, whose rows take turns; dp: two, of which the second is peeled; fwd, fw: "
                "forward rendering with and without stored depths; kg: a k-buffer as G-buffer"),
            sim::field<&P::lights>("spot lights: those of the scene first, then some around it")
                .unit("lights")
                .range(0, 64),
            sim::field<&P::shadows>("none, opaque (of all surfaces), transparent (panes let their colour pass)"),
            sim::field<&P::shadow_maps>("with transparent shadows: rows: rows take turns, opaque surfaces and all; "
                                        "two-class: a k-buffer, with methods that have none"),
            sim::field<&P::refraction>("panes show what lies aside of what is behind them"),
            sim::field<&P::refraction_coefficient>("offset of a normal across the view, over the picture's height")
                .range(0.0, 1.0),
            sim::field<&P::map_size>("edge of the shadow maps").unit("texels").range(2, 8192),
            sim::field<&P::bias>("that receivers come nearer to the light, over its range").range(0.0, 1.0),
            sim::field<&P::slope_bias>(
                "of the depths in shadow maps, in changes from one texel to the next: a point asks "
                "two texels, of which one may lie that far away")
                .range(0.0F, 1000.0F),
            sim::field<&P::intensity>("of each light").range(0.0, 1000.0),
            sim::field<&P::ambient>("light that reaches every surface").range(0.0F, 1.0F),
            sim::field<&P::specular>("of surfaces whose materials state nothing, and of those that state no metal "
                                     "times their strength")
                .range(0.0F, 1.0F),
            sim::field<&P::specular_power>("of surfaces whose materials state nothing").range(0.0F, 255.0F),
            sim::field<&P::maps>("materials state normals, how they reflect and light that they send out, by maps and "
                                 "factors; else none does"),
            sim::field<&P::lit_once>("fwd, fw: a stencil lets each light add to a pixel once, so that of surfaces in "
                                     "one place the first alone is lit; the thesis has none, and lights them all"),
            sim::field<&P::truth_filter>("panes between a light and a point that ray-traced truth looks through. "
                                         "nearest: the one next to the light, as shadow maps do; product: all. No "
                                         "method's picture depends on it"));
    }
};
static_assert(sim::fully_described<DeferredParams>);

} // namespace traces
