#include "pipeline/functional/frame_streams.hpp"

namespace pipeline {

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
        streams.push_back(
            pass.parts.empty()
                ? rasterize(*frame.resources, frame.draws, pass.draws, frame.view_of(pass), options)
                : rasterize_parts(*frame.resources, frame.draws, pass.parts, frame.view_of(pass), options));
    }
    return streams;
}

} // namespace pipeline
