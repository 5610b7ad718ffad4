#include "tests/support/replay.hpp"

namespace support {

std::vector<pipeline::FragmentStream> rasterize_frame(const pipeline::Frame& frame, unsigned threads) {
    pipeline::FrontEndOptions options;
    options.colours    = frame.needs.colours;
    options.textures   = frame.needs.textures;
    options.alpha_test = frame.needs.alpha_test;
    options.threads    = threads;
    std::vector<pipeline::FragmentStream> streams;
    for (const pipeline::Pass& pass : frame.passes)
        if (pass.kind == pipeline::PassKind::draw)
            streams.push_back(pipeline::rasterize(*frame.resources, frame.draws, pass.draws, frame.view, options));
    return streams;
}

Replay::Replay(const std::string& scene, const ReplayOptions& options) {
    const traces::Scene     loaded = traces::load_scene(scene);
    traces::WorkloadOptions knobs;
    for (const std::string& knob : options.knobs) knobs.set(knob);
    frame   = traces::build_frame(loaded, traces::make_view(loaded, options.camera, options.width, options.height),
                                  options.workload, knobs);
    streams = rasterize_frame(frame);
    reference = pipeline::run_reference(frame, streams);
}

pipeline::RunResult Replay::run(const std::string& design, const std::vector<std::string>& settings,
                                pipeline::MachineOptions options) const {
    sim::Config config;
    for (const std::string& setting : settings) config.set(setting);
    pipeline::GpuParams gpu;
    config.read("", gpu);
    models::check_design_sections(config);
    const auto model = models::make_design(design, config);
    config.expect_all_used();
    pipeline::Machine machine(gpu, frame, streams, *model, options);
    return machine.run(reference);
}

} // namespace support
