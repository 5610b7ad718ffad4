#include "reports/stability/replay.hpp"

#include "models/kbuffers/library.hpp"
#include "pipeline/functional/frame_streams.hpp"
#include "sim/config.hpp"
#include "traces/camera.hpp"
#include "traces/submission.hpp"

namespace reports::stability {

Replay::Replay(const std::string& scene, const ReplayOptions& options) : Replay(traces::load_scene(scene), options) {}

Replay::Replay(traces::Scene of, ReplayOptions how) : scene(std::move(of)), options(std::move(how)) {
    pipeline::View view = traces::make_view(scene, options.camera, options.width, options.height);
    view.samples = options.samples;
    frame = traces::build_frame(scene, view, options.workload, traces::WorkloadOptions::of(options.knobs));
    pipeline::FrontEndOptions front_end;
    front_end.threads = options.threads;
    streams = pipeline::rasterize_frame(frame, front_end);
    reference = pipeline::run_reference(frame, streams, 1, options.threads);
}

pipeline::RunResult Replay::run(const std::string& design, const std::vector<std::string>& settings,
                                pipeline::MachineOptions machine) const {
    sim::Config config;
    for (const std::string& setting : settings) config.set(setting);
    pipeline::GpuParams gpu;
    config.read("", gpu);
    models::check_design_sections(config);
    const auto model = models::make_design(design, config);
    config.expect_all_used();
    const auto judged_by_own = [&](const pipeline::Frame& drawn, const std::vector<pipeline::FragmentStream>& of) {
        return pipeline::Machine(gpu, drawn, of, *model, machine)
            .run(pipeline::run_reference(drawn, of, 1, options.threads, gpu.rop.fp16_overflow));
    };
    if (model->submission().changes()) {
        const pipeline::Frame other = traces::submitted(frame, model->submission());
        return judged_by_own(other, pipeline::rasterize_frame(other));
    }
    if (gpu.rop.fp16_overflow != reference.fp16_overflow) return judged_by_own(frame, streams);
    return pipeline::Machine(gpu, frame, streams, *model, machine).run(reference);
}

} // namespace reports::stability
