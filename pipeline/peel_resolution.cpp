#include "pipeline/peel_resolution.hpp"

#include "pipeline/functional/surface_texel.hpp"

#include <algorithm>

namespace pipeline {

namespace {

// A fragment is behind a captured one when its depth is at least that of the captured code plus eps.
bool behind(const PassesSite& site, float depth, float captured) {
    return static_cast<double>(depth) >=
           static_cast<double>(depth_value(site.depth_format, depth_code(site.depth_format, captured))) + site.eps;
}

/// @param depths of a pixel, ascending
PeelLoss loss_among(const PassesSite& site, std::span<const float> depths) {
    for (std::size_t i = 0; site.rule == PeelRule::eps && i < depths.size(); ++i)
        if (behind(site, depths[i], depths[i]) || (i + 1 < depths.size() && !behind(site, depths[i + 1], depths[i])))
            return PeelLoss::eps; // captured again and again, or never
    for (std::size_t i = 0; i + 1 < depths.size(); ++i)
        if (depths[i] != depths[i + 1] &&
            depth_code(site.depth_format, depths[i]) == depth_code(site.depth_format, depths[i + 1]))
            return PeelLoss::depth_format;
    return PeelLoss::none;
}

} // namespace

std::vector<PeelLoss> peel_losses(const PassesSite& site, const FragmentStream& stream,
                                  std::span<const std::size_t> places) {
    std::vector<std::vector<float>> depths(places.size());
    for (std::size_t id = 0; id < stream.quads.size(); ++id) {
        const Quad& quad = stream.quads[id];
        for (std::size_t lane = 0; lane < 4; ++lane) {
            if ((quad.alive >> lane & 1U) == 0) continue;
            const std::size_t place = (quad.y + lane / 2) * std::size_t{stream.width} + quad.x + lane % 2;
            const auto found = std::lower_bound(places.begin(), places.end(), place);
            if (found != places.end() && *found == place)
                depths[static_cast<std::size_t>(found - places.begin())].push_back(stream.depths[id][lane]);
        }
    }
    std::vector<PeelLoss> losses(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        std::sort(depths[i].begin(), depths[i].end());
        losses[i] = loss_among(site, depths[i]);
    }
    return losses;
}

} // namespace pipeline
