#include "reports/geometry/laboratory.hpp"

#include "models/gpu_library.hpp"
#include "traces/camera.hpp"
#include "traces/loads.hpp"
#include "traces/workloads.hpp"

#include <fmt/format.h>

namespace reports {

PreparedFrame prepare_frame(const GeometryExperiment& experiment, const pipeline::GpuParams& gpu) {
    traces::PreparedScene prepared = traces::prepare_scene(traces::load_scene(experiment.scene), experiment.prepare,
                                                           gpu.geometry.vertex_reuse, gpu.geometry.vertex_fetch.cache);
    const traces::Scene& scene = prepared.scene;
    const traces::Load load = traces::geometry_feed_load(experiment.reads_all);
    // No fragment is made, so any view will do.
    const pipeline::View view = traces::make_view(scene, "auto", 64, 64);
    pipeline::Frame frame = traces::build_frame(scene, view, load.workload, traces::WorkloadOptions::of(load.settings));
    frame.submission = experiment.submission;
    return {std::make_shared<const pipeline::Frame>(std::move(frame)),
            std::move(prepared.steps),
            traces::measure_meshes(scene, gpu.geometry.vertex_reuse, gpu.geometry.vertex_fetch.cache),
            scene.triangles_drawn,
            scene.vertices,
            scene.name,
            scene.hash,
            scene.notes};
}

pipeline::VertexPathResult run_geometry(const pipeline::GpuParams& gpu, const pipeline::Frame& frame, Fidelity fidelity,
                                        const std::atomic<bool>* stop, std::uint64_t seed) {
    pipeline::VertexPathOptions options;
    options.stop = stop;
    options.seed = seed;
    return fidelity == Fidelity::detailed ? pipeline::run_vertex_path(gpu, frame, options)
                                          : pipeline::estimate_vertex_path(gpu, frame, options);
}

pipeline::GpuParams configured_gpu(const std::string& gpu, const std::vector<std::string>& settings) {
    sim::Config config = models::load_gpu(gpu);
    for (const std::string& setting : settings) config.set(setting);
    pipeline::GpuParams params;
    config.read("", params);
    config.expect_all_used();
    return params;
}

pipeline::GpuParams gpu_params(const std::string& gpu, const std::map<std::string, double>& values) {
    std::vector<std::string> settings;
    for (const auto& [path, value] : values) settings.push_back(fmt::format("{}={:.17g}", path, value));
    return configured_gpu(gpu, settings);
}

} // namespace reports
