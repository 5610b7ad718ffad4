#include "traces/workloads/surface_shader.hpp"

#include "pipeline/functional/sample_pattern.hpp"
#include "pipeline/sample_planes.hpp"

#include <array>

namespace traces {

namespace {

constexpr float silhouette_light = 0.1F;
constexpr std::array<std::array<std::int32_t, 2>, 5> places{{{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

using Around = std::array<PixelSurface, places.size()>; ///< a pixel and its neighbours

/// What one pixel has to know of the picture.
class ShapeAround final : public SurfaceShape {
  public:
    ShapeAround(std::shared_ptr<const ViewRays> rays, const pipeline::View& view, std::uint32_t x, std::uint32_t y,
                const Around& around)
        : SurfaceShape(std::move(rays), view.width, view.height), x_(x), y_(y), around_(around) {}

    double distance(std::uint32_t x, std::uint32_t y) const override {
        if (y != y_) return around_[y > y_ ? 3 : 4].distance;
        return around_[x == x_ ? 0 : x > x_ ? 1 : 2].distance;
    }

  private:
    std::uint32_t x_, y_;
    const Around& around_;
};

class SurfaceShader final : public pipeline::Shader {
  public:
    SurfaceShader(const models::PictureSetup& setup, SurfaceLook&& look) : setup_(setup), look_(std::move(look)) {
        for (std::uint32_t sample = 0; sample < setup_.view.samples; ++sample)
            rays_.push_back(std::make_shared<const ViewRays>(
                setup_.view.samples == 1 ? setup_.view : view_of_sample(setup_.view, sample)));
    }

    pipeline::ShaderShape shape() const override { return {.reads = 1, .registers = setup_.program->targets() + 6}; }

    void shade(const pipeline::ShaderInput& input, pipeline::SurfaceAccess& surfaces,
               pipeline::ShaderOutput& output) const override {
        std::array<glm::dvec3, 4> sums{};
        for (std::uint32_t sample = 0; sample < setup_.view.samples; ++sample) {
            std::array<Around, 4> around;
            for (std::size_t place = 0; place < places.size(); ++place) look_at(input, surfaces, sample, place, around);
            // Places from distances, two steps along the surface, their product, its length, the light.
            surfaces.issue(5 * 2 + 2 * 6 + 2 + 3 + 2, input.pixels);
            for (std::uint32_t i = 0; i < 4; ++i)
                sums[i] += glm::dvec3(colour(input.x + i % 2, input.y + i / 2, sample, around[i]));
        }
        for (std::size_t i = 0; i < 4; ++i)
            output.colours[0][i] = glm::vec4(glm::vec3(sums[i] / static_cast<double>(setup_.view.samples)), 1.0F);
    }

  private:
    void look_at(const pipeline::ShaderInput& input, pipeline::SurfaceAccess& surfaces, std::uint32_t sample,
                 std::size_t place, std::array<Around, 4>& around) const {
        const pipeline::View& view = setup_.view;
        const auto plane = static_cast<std::int32_t>(sample * pipeline::plane_rows(view.height, view.samples));
        pipeline::QuadPlaces at(input);
        unsigned inside = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            at.x[i] += places[place][0];
            at.y[i] += places[place][1];
            const bool seen = at.x[i] >= 0 && at.x[i] < static_cast<std::int32_t>(view.width) && at.y[i] >= 0 &&
                              at.y[i] < static_cast<std::int32_t>(view.height);
            inside |= (seen ? 1U : 0U) << i;
            at.y[i] += plane;
        }
        const unsigned pixels = input.pixels & inside;
        const auto entries = surfaces.pixels(0, at.x, at.y, pixels, 0, setup_.program->targets());
        surfaces.issue(look_.instructions_to_find + models::instructions_to_drain(*setup_.program), pixels);
        for (std::size_t i = 0; i < 4; ++i)
            if (entries[i] != nullptr) around[i][place] = look_.find(models::drained(*setup_.program, entries[i]));
    }

    glm::vec3 colour(std::uint32_t x, std::uint32_t y, std::uint32_t sample, const Around& around) const {
        if (around[0].distance == SurfaceShape::none) return setup_.background;
        const ShapeAround shape(rays_[sample], setup_.view, x, y, around);
        const glm::vec3 lit = look_.colour(around[0].kind);
        if (look_.silhouettes && shape.is_silhouette(x, y)) return lit * silhouette_light;
        return lit * static_cast<float>(shape.lambert(x, y));
    }

    models::PictureSetup setup_;
    SurfaceLook look_;
    std::vector<std::shared_ptr<const ViewRays>> rays_; ///< of each sample
};

} // namespace

std::shared_ptr<const pipeline::Shader> surface_shader(const models::PictureSetup& setup, SurfaceLook look) {
    return std::make_shared<const SurfaceShader>(setup, std::move(look));
}

} // namespace traces
