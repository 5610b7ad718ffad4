#include "traces/workloads.hpp"

#include "sim/check.hpp"
#include "sim/suggest.hpp"
#include "traces/workloads/methods.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace traces {

void WorkloadOptions::set(std::string_view assignment) { add_assignment(values, assignment, "workload"); }

const std::vector<Workload>& workloads() {
    static const std::vector<Workload> list = {transparency_workload(), opaque_workload(), blended_workload(),
                                               geometry_workload()};
    return list;
}

pipeline::Frame frame_of(const Scene& scene, const pipeline::View& view) {
    pipeline::Frame frame;
    frame.resources = scene.resources;
    frame.draws = scene.draws;
    frame.view = view;
    return frame;
}

pipeline::Frame build_frame(const Scene& scene, const pipeline::View& view, const std::string& workload,
                            const WorkloadOptions& options) {
    std::vector<std::string> known;
    for (const Workload& one : workloads()) {
        if (one.id == workload) {
            pipeline::Frame frame = one.build(scene, view, options);
            frame.workload = workload;
            return frame;
        }
        known.push_back(one.id);
    }
    throw sim::InputError(fmt::format("workload: expected one of {}, got '{}'{}", fmt::join(known, ", "), workload,
                                      sim::did_you_mean(workload, known)));
}

} // namespace traces
