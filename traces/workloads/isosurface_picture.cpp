#include "traces/workloads/isosurface_picture.hpp"

#include "models/programs/isosurface.hpp"
#include "models/programs/nearest_k.hpp" // empty_depth
#include "pipeline/frame.hpp"
#include "traces/workloads/surface_image.hpp"

namespace traces {

namespace {

constexpr std::array<glm::vec3, 6> colours{{{0.85F, 0.55F, 0.2F},
                                            {0.2F, 0.5F, 0.85F},
                                            {0.4F, 0.7F, 0.25F},
                                            {0.8F, 0.25F, 0.25F},
                                            {0.6F, 0.4F, 0.75F},
                                            {0.85F, 0.8F, 0.3F}}};

constexpr float silhouette_light = 0.1F;

class IsosurfacePicture final : public pipeline::Resolve {
  public:
    explicit IsosurfacePicture(bool silhouettes) : silhouettes_(silhouettes) {}

    std::vector<float> picture(const pipeline::Frame& frame,
                               const pipeline::FinishedSurfaces& surfaces) const override {
        const std::span<const float> kbuffer = surfaces.kbuffer;
        const std::size_t floats = frame.program->floats_per_pixel(), pixels = kbuffer.size() / floats;
        SurfaceImage surface(frame.view);
        std::vector<std::size_t> iso(pixels);
        for (std::size_t i = 0; i < pixels; ++i) {
            const auto state = models::isosurface_state(*frame.program, kbuffer.data() + i * floats);
            if (state.distance == models::empty_depth || !(state.iso >= 0.0F)) continue;
            surface.set_distance(i, static_cast<double>(state.distance));
            iso[i] = static_cast<std::size_t>(state.iso);
        }
        std::vector<float> picture;
        picture.reserve(pixels * 4);
        for (std::uint32_t y = 0; y < surface.height(); ++y)
            for (std::uint32_t x = 0; x < surface.width(); ++x) {
                glm::vec3 colour(frame.background);
                if (surface.sees(x, y))
                    colour = colours[iso[picture.size() / 4] % colours.size()] * light(surface, x, y);
                picture.insert(picture.end(), {colour.r, colour.g, colour.b, 1.0F});
            }
        return picture;
    }

  private:
    float light(const SurfaceImage& surface, std::uint32_t x, std::uint32_t y) const {
        if (silhouettes_ && surface.is_silhouette(x, y)) return silhouette_light;
        return static_cast<float>(surface.lambert(x, y));
    }

    bool silhouettes_;
};

} // namespace

std::shared_ptr<const pipeline::Resolve> make_isosurface_picture(bool silhouettes) {
    return std::make_shared<const IsosurfacePicture>(silhouettes);
}

} // namespace traces
