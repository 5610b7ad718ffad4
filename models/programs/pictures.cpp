#include "models/programs/pictures.hpp"

#include "models/programs/finite.hpp"
#include "pipeline/frame.hpp"

namespace models {

namespace {

using pipeline::Frame;
using pipeline::ModifyProgram;

class ColourPicture final : public pipeline::Resolve {
  public:
    ColourPicture(const ColourSlots& slots, bool of_state) : slots_(slots), of_state_(of_state) {}

    std::vector<float> picture(const Frame& frame, const pipeline::FinishedSurfaces& surfaces) const override {
        const auto [kbuffer, opaque_colour, depth] = surfaces;
        const ModifyProgram& program = *frame.program;
        const std::uint32_t floats = program.floats_per_pixel();
        std::vector<float> picture(kbuffer.size() / floats * 4, 1.0F);
        for (std::size_t i = 0; i < picture.size() / 4; ++i) {
            const glm::vec4 seen = colour(program, kbuffer.data() + i * floats);
            for (int channel = 0; channel < 3; ++channel) {
                const std::size_t at = i * 4 + static_cast<std::size_t>(channel);
                const float behind = opaque_colour.empty() ? frame.background[channel] : opaque_colour[at];
                picture[at] = finite(seen[channel] + seen.a * behind);
            }
        }
        return picture;
    }

  private:
    glm::vec4 at(const float* floats) const {
        return {floats[slots_[0]], floats[slots_[1]], floats[slots_[2]], floats[slots_[3]]};
    }

    /// Premultiplied colour and transmittance of a pixel.
    glm::vec4 colour(const ModifyProgram& program, const float* pixel) const {
        if (of_state_) return at(pixel + std::size_t{program.k()} * program.floats_per_entry());
        glm::vec4 seen(0.0F, 0.0F, 0.0F, 1.0F);
        for (std::uint32_t i = 0; i < program.k(); ++i) {
            const glm::vec4 node = at(pixel + std::size_t{i} * program.floats_per_entry());
            seen = {glm::vec3(seen) + seen.a * glm::vec3(node), seen.a * node.a};
        }
        return seen;
    }

    ColourSlots slots_;
    bool of_state_;
};

} // namespace

std::shared_ptr<const pipeline::Resolve> state_picture(const ColourSlots& slots) {
    return std::make_shared<const ColourPicture>(slots, true);
}

std::shared_ptr<const pipeline::Resolve> node_picture(const ColourSlots& slots) {
    return std::make_shared<const ColourPicture>(slots, false);
}

} // namespace models
