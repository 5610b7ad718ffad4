// How an application hands over the triangles of k-buffer passes when a design asks for it: sorted by the depth of
// their centroids, in small batches, each followed by a draw that forces a flush (specification 004, section 3.2: A8,
// A9).
#pragma once

#include "pipeline/frame.hpp"
#include "pipeline/output/kbuffer_design.hpp"

namespace traces {

/// The frame as `plan` wants it. Triangles of all draws of a k-buffer pass are sorted together, front to back by the
/// eye-space depth of their centroids, equal depths in their old order; each run of triangles of one instance of a draw
/// becomes a part (pipeline::DrawPart), of at most plan.batch_triangles triangles. Strips and fans become lists. Other
/// passes stay as they are. Draws keep their numbers; a draw "flush" may follow them. No triangle is lost. Throws
/// sim::InputError when there are more than 2^32 - 1 indices.
pipeline::Frame submitted(const pipeline::Frame& frame, const pipeline::SubmissionPlan& plan);

} // namespace traces
