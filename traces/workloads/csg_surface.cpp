#include "traces/workloads/csg_surface.hpp"

#include "models/programs/nearest_k.hpp" // empty_depth

#include <algorithm>

namespace traces {

namespace {

class Walk {
  public:
    Walk(const pipeline::Frame& frame, const CsgExpression& expression)
        : program_(*frame.program), expression_(expression), inside_(frame.draws.size()) {}

    /// The entry on the surface; null where there is none.
    const float* first_inside(const float* pixel) {
        std::fill(inside_.begin(), inside_.end(), std::uint8_t{0});
        for (std::uint32_t i = 0; i < program_.k(); ++i) {
            const float* entry = pixel + std::size_t{i} * program_.floats_per_entry();
            if (entry[0] == models::empty_depth) return nullptr;
            inside_[object_of(entry)] ^= 1U;
            if (expression_(inside_)) return entry;
        }
        return nullptr;
    }

    std::uint32_t object_of(const float* entry) const {
        return std::min(static_cast<std::uint32_t>(entry[1]), static_cast<std::uint32_t>(inside_.size() - 1));
    }

  private:
    const pipeline::ModifyProgram& program_;
    const CsgExpression& expression_;
    std::vector<std::uint8_t> inside_; ///< by draw
};

} // namespace

CsgSurface csg_surface(const pipeline::Frame& frame, std::span<const float> kbuffer, const CsgExpression& expression) {
    const std::size_t pixels = std::size_t{frame.view.width} * frame.view.height;
    const pipeline::EyeDepth depth(frame.view.projection);
    CsgSurface surface{SurfaceImage(frame.view), std::vector<std::uint32_t>(pixels)};
    Walk walk(frame, expression);
    for (std::size_t i = 0; i < pixels; ++i) {
        const float* entry = walk.first_inside(kbuffer.data() + i * frame.program->floats_per_pixel());
        if (entry == nullptr) continue;
        surface.image.set_distance(i, depth.distance(entry[0]));
        surface.objects[i] = walk.object_of(entry);
    }
    return surface;
}

} // namespace traces
