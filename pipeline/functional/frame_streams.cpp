#include "pipeline/functional/frame_streams.hpp"

namespace pipeline {

std::vector<FragmentStream> rasterize_frame(const Frame& frame, FrontEndOptions options) {
    options.colours = frame.needs.colours;
    options.fragment_colour = frame.needs.fragment_colour;
    options.textures = frame.needs.textures;
    options.alpha_test = frame.needs.alpha_test;
    std::vector<FragmentStream> streams;
    for (const Pass& pass : frame.passes) {
        if (pass.kind != PassKind::draw) continue;
        options.both_faces = pass.both_faces;
        streams.push_back(rasterize(*frame.resources, frame.draws, pass.draws, frame.view, options));
    }
    return streams;
}

} // namespace pipeline
