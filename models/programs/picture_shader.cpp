#include "models/programs/picture_shader.hpp"

#include "pipeline/sample_planes.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace models {

namespace {

class PictureShader final : public pipeline::Shader {
  public:
    PictureShader(PictureSetup&& setup, std::uint32_t instructions, PixelColour&& colour)
        : setup_(std::move(setup)), instructions_(instructions), colour_(std::move(colour)) {
        instructions_ += instructions_to_drain(*setup_.program);
    }

    pipeline::ShaderShape shape() const override {
        return {.reads = setup_.over_surface ? 2U : 1U, .registers = setup_.program->targets() + 2};
    }

    void shade(const pipeline::ShaderInput& input, pipeline::SurfaceAccess& surfaces,
               pipeline::ShaderOutput& output) const override {
        const pipeline::QuadPlaces at(input);
        std::array<glm::dvec3, 4> sums{};
        for (std::uint32_t sample = 0; sample < setup_.view.samples; ++sample) {
            pipeline::LaneIndices row = at.y;
            const auto plane =
                static_cast<std::int32_t>(sample * pipeline::plane_rows(setup_.view.height, setup_.view.samples));
            for (std::int32_t& of_plane : row) of_plane += plane;
            const auto entries = surfaces.pixels(0, at.x, row, input.pixels, 0, setup_.program->targets());
            pipeline::QuadTexels behind;
            behind.fill(glm::vec4(setup_.background, 1.0F));
            if (setup_.over_surface) behind = surfaces.fetch(1, at.x, at.y, input.pixels, sample);
            surfaces.issue(instructions_, input.pixels);
            for (std::uint32_t i = 0; i < 4; ++i)
                if (entries[i] != nullptr)
                    sums[i] += glm::dvec3(colour_({input.x + i % 2, input.y + i / 2, sample},
                                                  drained(*setup_.program, entries[i]), glm::vec3(behind[i])));
        }
        for (std::size_t i = 0; i < 4; ++i)
            output.colours[0][i] = glm::vec4(glm::vec3(sums[i] / static_cast<double>(setup_.view.samples)), 1.0F);
    }

  private:
    PictureSetup setup_;
    std::uint32_t instructions_;
    PixelColour colour_;
};

} // namespace

const float* drained(const pipeline::ModifyProgram& program, const float* pixel) {
    if (!program.drains()) return pixel;
    thread_local std::vector<float> copy;
    copy.assign(pixel, pixel + program.floats_per_pixel());
    program.drain(copy.data());
    return copy.data();
}

// Four pixels side by side, as where the program runs in a shader; a drain pops each entry.
std::uint32_t instructions_to_drain(const pipeline::ModifyProgram& program) {
    return program.drains() ? program.k() * program.cost().operations / 4 : 0;
}

std::shared_ptr<const pipeline::Shader> picture_shader(PictureSetup setup, std::uint32_t instructions,
                                                       PixelColour colour) {
    return std::make_shared<const PictureShader>(std::move(setup), instructions, std::move(colour));
}

} // namespace models
