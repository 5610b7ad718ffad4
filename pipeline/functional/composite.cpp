#include "pipeline/functional/composite.hpp"

#include "pipeline/functional/eye_depth.hpp"
#include "pipeline/functional/sample_pattern.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace pipeline {

namespace {

/// A brightness for a window depth.
class GreyRamp {
  public:
    explicit GreyRamp(const glm::mat4& projection)
        : depth_(projection), near_(depth_.distance(0.0F)), range_(std::log(depth_.distance(1.0F) / near_)) {
        logarithmic_ = depth_.perspective() && near_ > 0.0 && range_ > 0.0;
    }

    float operator()(float depth) const {
        const double share = logarithmic_ ? std::log(depth_.distance(depth) / near_) / range_ : depth;
        return static_cast<float>(0.9 - 0.8 * std::clamp(share, 0.0, 1.0));
    }

  private:
    EyeDepth depth_;
    double near_, range_;
    bool logarithmic_ = false;
};

class Compositor {
  public:
    explicit Compositor(const Frame& frame)
        : program_(*frame.program),
          opacity_(frame.opacity),
          ramp_(frame.view.projection),
          cleared_(program_.floats_per_pixel()),
          floats_(program_.floats_per_entry()),
          slot_(program_.depth_slot()) {
        program_.clear(cleared_.data());
    }

    glm::vec3 operator()(const float* pixel, glm::vec3 background) const {
        glm::vec3 colour(0.0F);
        float transmitted = 1.0F;
        for (std::uint32_t i = 0; i < program_.k(); ++i) {
            const float* entry = pixel + std::size_t{i} * floats_;
            if (entry[slot_] == cleared_[std::size_t{i} * floats_ + slot_]) continue;
            colour += transmitted * opacity_ * colour_of(entry);
            transmitted *= 1.0F - opacity_;
        }
        return colour + transmitted * background;
    }

  private:
    glm::vec3 colour_of(const float* entry) const {
        if (floats_ != 4) return glm::vec3(ramp_(entry[slot_]));
        glm::vec3 colour;
        int channel = 0;
        for (std::uint32_t i = 0; i < 4; ++i)
            if (i != slot_) colour[channel++] = entry[i];
        return colour;
    }

    const ModifyProgram& program_;
    float opacity_;
    GreyRamp ramp_;
    std::vector<float> cleared_;
    std::uint32_t floats_, slot_;
};

std::vector<float> composite_layers(const Frame& frame, const FinishedSurfaces& surfaces) {
    const auto [kbuffer, opaque_colour, depth] = surfaces;
    const std::size_t pixels = std::size_t{frame.view.width} * frame.view.height;
    const std::size_t floats = frame.program->floats_per_pixel();
    const Compositor layers(frame);
    std::vector<float> picture(pixels * 4);
    for (std::size_t i = 0; i < pixels; ++i) {
        const float* behind = opaque_colour.empty() ? nullptr : opaque_colour.data() + i * 4;
        const glm::vec3 background =
            behind == nullptr ? glm::vec3(frame.background) : glm::vec3(behind[0], behind[1], behind[2]);
        const glm::vec3 colour = layers(kbuffer.data() + i * floats, background);
        picture[i * 4 + 0] = colour.r;
        picture[i * 4 + 1] = colour.g;
        picture[i * 4 + 2] = colour.b;
        picture[i * 4 + 3] = 1.0F;
    }
    return picture;
}

std::vector<float> picture_of(const Frame& frame, const FinishedSurfaces& surfaces) {
    return frame.resolve ? frame.resolve->picture(frame, surfaces) : composite_layers(frame, surfaces);
}

std::vector<float> picture_of_samples(const Frame& frame, const FinishedSurfaces& surfaces) {
    const View planes = frame.view;
    std::vector<float> pictures(planes.places() * 4);
    Frame seen = frame;
    for (std::uint32_t sample = 0; sample < planes.samples; ++sample) {
        const auto plane = [&](std::span<const float> surface, std::size_t floats) {
            return surface.empty() ? surface : plane_of_sample(planes, sample, surface, floats);
        };
        seen.view = view_of_sample(planes, sample);
        const auto picture = picture_of(seen, {plane(surfaces.kbuffer, frame.program->floats_per_pixel()),
                                               plane(surfaces.colour, 4), plane(surfaces.depth, 1)});
        std::copy(picture.begin(), picture.end(), plane_of_sample(planes, sample, std::span(pictures), 4).begin());
    }
    return mean_of_samples(planes, pictures, 4);
}

} // namespace

std::vector<float> composite(const Frame& frame, const FinishedSurfaces& surfaces) {
    CHECK(frame.program != nullptr);
    const std::size_t places = frame.view.places();
    CHECK(surfaces.kbuffer.size() == frame.view_of_kbuffer().places() * frame.program->floats_per_pixel());
    CHECK(surfaces.colour.empty() || surfaces.colour.size() == places * 4);
    CHECK(surfaces.depth.empty() || surfaces.depth.size() == places);
    return with_drained(frame, surfaces, [&frame](const FinishedSurfaces& finished) {
        return frame.view.samples == 1 ? picture_of(frame, finished) : picture_of_samples(frame, finished);
    });
}

} // namespace pipeline
