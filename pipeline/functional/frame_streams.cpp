#include "pipeline/functional/frame_streams.hpp"

#include <algorithm>

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

} // namespace

std::vector<FragmentStream> rasterize_frame(const Frame& frame, FrontEndOptions options) {
    options.fragment_colour = frame.needs.fragment_colour;
    options.alpha_test = frame.needs.alpha_test;
    std::vector<FragmentStream> streams;
    for (const Pass& pass : frame.passes) {
        if (pass.kind != PassKind::draw) continue;
        const Needs needs = frame.needs_of(pass);
        options.colours = needs.colours;
        options.textures = needs.textures;
        options.both_faces = pass.both_faces;
        options.depth_step = depth_step(frame.depth_format);
        options.states = pass.states;
        const std::vector<std::uint32_t> of_parts = states_of_parts(pass);
        options.state_of_draw = pass.parts.empty() ? pass.state_of_draw : of_parts;
        streams.push_back(
            pass.parts.empty()
                ? rasterize(*frame.resources, frame.draws, pass.draws, frame.view_of(pass), options)
                : rasterize_parts(*frame.resources, frame.draws, pass.parts, frame.view_of(pass), options));
    }
    return streams;
}

} // namespace pipeline
