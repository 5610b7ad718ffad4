// The rendering methods, one file each.
#pragma once

#include "traces/parameters.hpp"
#include "traces/workloads.hpp"

#include <fmt/format.h>
#include <string>
#include <utility>

namespace traces {

Workload transparency_workload();
Workload opaque_workload();
Workload blended_workload();
Workload geometry_workload();

/// A row of the table of workloads; `build` takes (scene, view, parameters).
template <sim::Described P, class Build>
Workload make_workload(std::string id, std::string summary, Build build) {
    const std::string place = fmt::format("workload {}", id);
    return {std::move(id), std::move(summary), sim::describe<P>(),
            [place, build](const Scene& scene, const pipeline::View& view, const WorkloadOptions& options) {
                return build(scene, view, read_parameters<P>(options.values, place));
            }};
}

/// What frames of all workloads have in common: the scene with all its draws, seen through `view`.
pipeline::Frame frame_of(const Scene& scene, const pipeline::View& view);

} // namespace traces
