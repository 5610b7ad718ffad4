#include "tests/support/frame_surfaces.hpp"

#include "pipeline/functional/surface_values.hpp"

#include <gtest/gtest.h>

namespace support {

pipeline::SurfaceStore surfaces_of(const Replay& replay) {
    pipeline::SurfaceStore surfaces(replay.frame.surfaces);
    std::size_t next = 0;
    for (const pipeline::Pass& pass : replay.frame.passes)
        if (pass.kind == pipeline::PassKind::clear)
            for (const pipeline::SurfaceId surface : pass.clears) surfaces.clear(surface);
        else
            run_reference_pass(replay.frame, pass, replay.streams[next++], surfaces);
    return surfaces;
}

std::vector<float> colours_named(const Replay& replay, const pipeline::SurfaceStore& surfaces,
                                 const std::string& name) {
    for (pipeline::SurfaceId i = 0; i < surfaces.count(); ++i)
        if (replay.frame.surfaces[i].name == name) return colours_of(surfaces, i);
    ADD_FAILURE() << name;
    return {};
}

} // namespace support
