// The rival of soft shadow maps: hard shadows of many point lights that share the area of one, averaged.
//
// Source: Bavoil 2007, sections 1.2 and 5.1 (specification 004, section 3.5: more than a hundred passes before banding
// disappears). Each light renders its own map and its own kernel; the eye's view is drawn once.
#pragma once

#include "reports/accuracy/accuracy.hpp"

#include <memory>

namespace reports {

struct AveragedShadows {
    std::uint32_t lights = 0;
    double sim_ms = 0, host_s = 0;
    FramePixels pixels; ///< alpha is the averaged visibility
    std::shared_ptr<const pipeline::Frame> frame;
};

/// For 4, 16, 64 ... lights up to request.averaged, each the first of the next. Throws sim::InputError for a workload
/// without a light.
std::vector<AveragedShadows> average_hard_shadows(const AccuracyRequest& request, const Supervision& supervision);

} // namespace reports
