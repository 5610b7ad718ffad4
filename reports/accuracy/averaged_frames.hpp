// The mean of many frames with cheaper settings (traces::Averaging), a rival to a workload's usual ones: hard shadows
// of many point lights against soft ones, say. What the frames share is drawn once.
#pragma once

#include "reports/accuracy/accuracy.hpp"

#include <memory>
#include <vector>

namespace reports {

struct AveragedFrames {
    std::uint32_t frames = 0;
    double sim_ms = 0, host_s = 0;
    FramePixels pixels; ///< of the last frame, with the mean of all pictures
    std::shared_ptr<const pipeline::Frame> frame;
};

/// For 4, 16, 64 ... frames up to request.averaged. Throws sim::InputError for a workload that has none to average,
/// naming those that have.
std::vector<AveragedFrames> average_frames(const AccuracyRequest& request, const Supervision& supervision);

} // namespace reports
