// A recording that is drawn by the reference, and by machines.
#pragma once

#include "models/kbuffers/library.hpp"
#include "pipeline/functional/frame_streams.hpp"
#include "pipeline/machine.hpp"
#include "pipeline/reference.hpp"
#include "sim/config.hpp"
#include "tests/support/recorded_frames.hpp"
#include "traces/recording/lower.hpp"

#include <string>
#include <vector>

namespace drawn_recording {

using pipeline::BlendFactor;
using pipeline::RasterState;
using traces::LowerOptions;

inline constexpr std::uint32_t width = 24, height = 16;
inline const glm::vec4 red(1, 0, 0, 1), green(0, 1, 0, 1), blue(0, 0, 1, 1), black(0, 0, 0, 1);

struct Drawn {
    pipeline::Frame frame;
    std::vector<pipeline::FragmentStream> streams;
    pipeline::ReferenceImage image;

    explicit Drawn(const traces::Recording& recording, const LowerOptions& options = {})
        : frame(traces::lower(recording, options, "test")),
          streams(pipeline::rasterize_frame(frame)),
          image(pipeline::run_reference(frame, streams)) {}

    glm::vec4 at(std::uint32_t x, std::uint32_t row) const {
        const float* rgba = &image.colour[(std::size_t{row} * frame.view.width + x) * 4];
        return {rgba[0], rgba[1], rgba[2], rgba[3]};
    }
    const pipeline::Pass* pass(const std::string& name) const {
        for (const pipeline::Pass& pass : frame.passes)
            if (pass.name == name) return &pass;
        return nullptr;
    }
};

inline RasterState depth_tested(bool write = true) {
    RasterState state;
    state.culling = pipeline::FaceCulling::none;
    state.depth.test = true;
    state.depth.write = write;
    return state;
}

inline RasterState blended(BlendFactor source, BlendFactor target, bool depth_test = false) {
    RasterState state = depth_tested(false);
    state.depth.test = depth_test;
    state.blend[0] = pipeline::blends::of({source, target});
    return state;
}
inline RasterState over() { return blended(BlendFactor::source_alpha, BlendFactor::one_minus_source_alpha); }

inline pipeline::RunResult run(const Drawn& drawn, const char* design) {
    sim::Config config;
    const auto made = models::make_design(design, config);
    pipeline::Machine machine({}, drawn.frame, drawn.streams, *made);
    return machine.run(drawn.image);
}

} // namespace drawn_recording
