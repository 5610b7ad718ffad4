#include "pipeline/functional/frame_streams.hpp"

#include "pipeline/functional/screen_stream.hpp"
#include "pipeline/functional/shade_pass.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <utility>

namespace pipeline {

namespace {

// The state of each part, which is that of the draw it belongs to.
std::vector<std::uint32_t> states_of_parts(const Pass& pass) {
    std::vector<std::uint32_t> states;
    if (pass.state_of_draw.empty()) return states;
    for (const DrawPart& part : pass.parts) {
        const auto draw = std::find(pass.draws.begin(), pass.draws.end(), part.draw) - pass.draws.begin();
        states.push_back(pass.state_of_draw.at(static_cast<std::size_t>(draw)));
    }
    return states;
}

FragmentStream rasterize_pass(const Frame& frame, const Pass& pass, FrontEndOptions options) {
    const Needs needs = frame.needs_of(pass);
    options.colours = needs.colours;
    options.normals = needs.fragment_normals;
    options.fragment_colour = needs.fragment_colour;
    options.textures = needs.textures;
    options.alpha_test = needs.alpha_test;
    options.both_faces = pass.both_faces;
    options.depth_step =
        depth_step(pass.depth == no_surface ? frame.depth_format : frame.surfaces.at(pass.depth).format);
    options.states = pass.states;
    const std::vector<std::uint32_t> of_parts = states_of_parts(pass);
    options.state_of_draw = pass.parts.empty() ? pass.state_of_draw : of_parts;
    return pass.parts.empty()
               ? rasterize(*frame.resources, frame.draws, pass.draws, frame.view_of(pass), options)
               : rasterize_parts(*frame.resources, frame.draws, pass.parts, frame.view_of(pass), options);
}

// Every pixel of the first target; the others are as large.
FragmentStream cover_screen(const Frame& frame, const Pass& pass) {
    CHECK(frame.screen_draw.has_value() && pass.writes_colour());
    const SurfaceInfo& target = frame.surfaces.at(pass.first_target());
    return screen_stream(target.width, target.height, *frame.screen_draw);
}

} // namespace

std::vector<FragmentStream> rasterize_frame(const Frame& frame, const FrontEndOptions& options) {
    std::vector<FragmentStream> streams;
    for (const Pass& pass : frame.passes) {
        if (!pass.rasterizes()) continue;
        FragmentStream& stream = streams.emplace_back(
            pass.kind == PassKind::screen ? cover_screen(frame, pass) : rasterize_pass(frame, pass, options));
        if (pass.shader == nullptr) continue;
        stream.given_colours = std::exchange(stream.colours, {});
        if (!pass.reads_surfaces()) shade(pass, stream, {}, options.threads);
    }
    return streams;
}

} // namespace pipeline
