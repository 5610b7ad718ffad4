#include "models/programs/pictures.hpp"

#include "models/programs/finite.hpp"
#include "pipeline/functional/eye_depth.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

namespace models {

namespace {

using pipeline::ModifyProgram;

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
    pipeline::EyeDepth depth_;
    double near_, range_;
    bool logarithmic_ = false;
};

class Compositor {
  public:
    Compositor(std::shared_ptr<const ModifyProgram> program, const glm::mat4& projection, float opacity)
        : program_(std::move(program)),
          opacity_(opacity),
          ramp_(projection),
          cleared_(program_->floats_per_pixel()),
          floats_(program_->floats_per_entry()),
          slot_(program_->depth_slot()) {
        program_->clear(cleared_.data());
    }

    glm::vec3 operator()(const PicturePlace&, const float* pixel, const glm::vec3& behind) const {
        glm::vec3 colour(0.0F);
        float transmitted = 1.0F;
        for (std::uint32_t i = 0; i < program_->k(); ++i) {
            const float* entry = pixel + std::size_t{i} * floats_;
            if (entry[slot_] == cleared_[std::size_t{i} * floats_ + slot_]) continue;
            colour += transmitted * opacity_ * colour_of(entry);
            transmitted *= 1.0F - opacity_;
        }
        return colour + transmitted * behind;
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

    std::shared_ptr<const ModifyProgram> program_;
    float opacity_;
    GreyRamp ramp_;
    std::vector<float> cleared_;
    std::uint32_t floats_, slot_;
};

glm::vec4 colour_at(const float* floats, const ColourSlots& slots) {
    return {floats[slots[0]], floats[slots[1]], floats[slots[2]], floats[slots[3]]};
}

/// Entries composited in stored order: premultiplied colour and transmittance.
glm::vec4 composited(const float* pixel, const ModifyProgram& program, const ColourSlots& slots) {
    glm::vec4 seen(0.0F, 0.0F, 0.0F, 1.0F);
    for (std::uint32_t i = 0; i < program.k(); ++i) {
        const glm::vec4 node = colour_at(pixel + std::size_t{i} * program.floats_per_entry(), slots);
        seen = {glm::vec3(seen) + seen.a * glm::vec3(node), seen.a * node.a};
    }
    return seen;
}

class NodesShader final : public pipeline::Shader {
  public:
    explicit NodesShader(std::shared_ptr<const ModifyProgram> program) : program_(std::move(program)) {}

    pipeline::ShaderShape shape() const override { return {.reads = 1, .registers = program_->targets() + 1}; }
    void shade(const pipeline::ShaderInput& input, pipeline::SurfaceAccess& surfaces,
               pipeline::ShaderOutput& output) const override {
        const pipeline::QuadPlaces at(input);
        const auto pixels = surfaces.pixels(0, at.x, at.y, input.pixels, 0, program_->targets());
        surfaces.issue(3 * program_->k(), input.pixels);
        for (std::size_t i = 0; i < 4; ++i)
            if (pixels[i] != nullptr) output.colours[0][i] = composited(pixels[i], *program_, {0, 1, 2, 3});
    }

  private:
    std::shared_ptr<const ModifyProgram> program_;
};

/// A premultiplied colour, and what it lets through, before what lies behind.
glm::vec3 before(const glm::vec4& seen, const glm::vec3& behind) {
    glm::vec3 colour;
    for (int channel = 0; channel < 3; ++channel) colour[channel] = finite(seen[channel] + seen.a * behind[channel]);
    return colour;
}

} // namespace

// A compare, and for the layer that is there two products and a sum; a product and a sum for what lies behind.
MakePicture layers_picture(float opacity) {
    return [opacity](const PictureSetup& setup) {
        const std::uint32_t ramp = setup.program->floats_per_entry() == 4 ? 0 : 6; // of a logarithm
        return picture_shader(setup, setup.program->k() * (4 + ramp) + 2,
                              Compositor(setup.program, setup.view.projection, opacity));
    };
}

MakePicture state_picture(const ColourSlots& slots) {
    return [slots](const PictureSetup& setup) {
        const std::size_t state = std::size_t{setup.program->k()} * setup.program->floats_per_entry();
        return picture_shader(setup, 2,
                              [slots, state](const PicturePlace&, const float* pixel, const glm::vec3& behind) {
                                  return before(colour_at(pixel + state, slots), behind);
                              });
    };
}

MakePicture node_picture(const ColourSlots& slots) {
    return [slots](const PictureSetup& setup) {
        return picture_shader(
            setup, 3 * setup.program->k() + 2,
            [slots, program = setup.program](const PicturePlace&, const float* pixel, const glm::vec3& behind) {
                return before(composited(pixel, *program, slots), behind);
            });
    };
}

std::shared_ptr<const pipeline::Shader> nodes_shader(std::shared_ptr<const ModifyProgram> program) {
    return std::make_shared<const NodesShader>(std::move(program));
}

} // namespace models
