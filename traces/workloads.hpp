// Rendering methods: each turns a scene into a frame, through a pass graph. One file per method in workloads/.
#pragma once

#include "pipeline/frame.hpp"
#include "sim/described.hpp"
#include "traces/scene.hpp"

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace traces {

/// Parameters of a workload by name; what is not named keeps its default. `values["k"] = 8`, or set("k=8").
struct WorkloadOptions {
    nlohmann::ordered_json values = nlohmann::ordered_json::object();

    /// "key=value" as on the command line. Throws sim::InputError when there is no key.
    void set(std::string_view assignment);
};

struct Workload {
    std::string id;
    std::string summary; ///< one line
    std::vector<sim::FieldInfo> parameters;
    std::function<pipeline::Frame(const Scene&, const pipeline::View&, const WorkloadOptions&)> build;
};

/// All workloads, in the order in which help lists them.
const std::vector<Workload>& workloads();

/// The frame of a workload. Throws sim::InputError for an unknown workload or parameter (naming what is near) and for
/// values out of range.
pipeline::Frame build_frame(const Scene& scene, const pipeline::View& view, const std::string& workload,
                            const WorkloadOptions& options = {});

} // namespace traces
