// Translucency: light from the background, absorbed inside the drawn objects.
//
// Source: Bavoil 2007, section 6.1.2 (specification 004, A12). Each draw is a homogeneous object with a closed surface.
// Its fragments, from front to back, are by turns where the ray enters it and where it leaves; the lengths between,
// along the ray, are attenuated by exp(-sigma * length). A fragment without a partner (of an open surface, or because
// the exit did not fit into k entries) begins no length. Each surface also transmits 1 - (1 - cos)^5 of the light,
// Schlick's Fresnel term without reflection at normal incidence.
#include "models/programs/nearest_k.hpp"
#include "sim/check.hpp"
#include "traces/workloads/methods.hpp"
#include "traces/workloads/view_rays.hpp"

#include <cmath>
#include <numeric>

namespace traces {

enum class Media : std::uint8_t { draws, one };

} // namespace traces

template <>
struct sim::EnumNames<traces::Media> {
    static constexpr std::array<std::string_view, 2> names{"draws", "one"};
};

namespace traces {

namespace {

struct TranslucencyParams {
    std::uint32_t k = 8;
    std::vector<double> sigma = {1.0};
    Media media = Media::draws;
    bool fresnel = false;
    std::array<float, 3> background = {1.0F, 1.0F, 1.0F};

    static constexpr auto fields() {
        using P = TranslucencyParams;
        return std::tuple(
            sim::field<&P::k>("surfaces kept per pixel").unit("surfaces").range(1, 64),
            sim::field<&P::sigma>("extinction in 1 / scene unit: one number, or a list with one for each draw")
                .range(0.0, 1e30),
            sim::field<&P::media>("draws: each draw is an object of its own, and an entry keeps which; one: all draws "
                                  "are the surface of one object, and an entry is a depth"),
            sim::field<&P::fresnel>("surfaces transmit less at grazing angles; entries then keep the cosine, too"),
            sim::field<&P::background>("linear RGB of the light behind everything").range(0.0F, 1.0F));
    }
};
static_assert(sim::fully_described<TranslucencyParams>);

models::EntryKind entry_of(const TranslucencyParams& params) {
    if (params.fresnel) return models::EntryKind::zor;
    return params.media == Media::draws ? models::EntryKind::zo : models::EntryKind::z;
}

std::vector<double> extinctions(const TranslucencyParams& params, std::size_t draws) {
    const std::size_t objects = params.media == Media::draws ? draws : 1;
    if (params.sigma.size() != 1 && params.sigma.size() != objects)
        throw sim::InputError(fmt::format("workload translucency: sigma: expected one number, or {} (one for each "
                                          "object), got {}",
                                          objects, params.sigma.size()));
    if (params.sigma.size() == objects) return params.sigma;
    return std::vector<double>(objects, params.sigma.front());
}

class TranslucencyPicture final : public pipeline::Resolve {
  public:
    TranslucencyPicture(std::vector<double> sigma, bool fresnel) : sigma_(std::move(sigma)), fresnel_(fresnel) {}

    std::vector<float> picture(const pipeline::Frame& frame,
                               const pipeline::FinishedSurfaces& surfaces) const override {
        const std::span<const float> kbuffer = surfaces.kbuffer;
        const ViewRays rays(frame.view);
        const std::size_t floats = frame.program->floats_per_pixel();
        std::vector<float> picture;
        picture.reserve(kbuffer.size() / floats * 4);
        for (std::uint32_t y = 0; y < frame.view.height; ++y)
            for (std::uint32_t x = 0; x < frame.view.width; ++x) {
                const float* pixel = kbuffer.data() + picture.size() / 4 * floats;
                const glm::vec3 colour = glm::vec3(frame.background) * transmittance(frame, pixel, rays, x, y);
                picture.insert(picture.end(), {colour.r, colour.g, colour.b, 1.0F});
            }
        return picture;
    }

  private:
    float transmittance(const pipeline::Frame& frame, const float* pixel, const ViewRays& rays, std::uint32_t x,
                        std::uint32_t y) const {
        const std::uint32_t floats = frame.program->floats_per_entry();
        std::vector<double> entered(sigma_.size(), outside);
        double optical_depth = 0.0, surfaces = 1.0;
        for (std::uint32_t i = 0; i < frame.program->k(); ++i) {
            const float* entry = pixel + std::size_t{i} * floats;
            if (entry[0] == models::empty_depth) break;
            if (fresnel_) surfaces *= fresnel_transmittance(entry[2]);
            const std::size_t object = sigma_.size() == 1 ? 0 : object_of(entry);
            const double distance = rays.distance(entry[0]);
            if (entered[object] == outside) {
                entered[object] = distance;
                continue;
            }
            optical_depth += sigma_[object] * rays.length(x, y, entered[object], distance);
            entered[object] = outside;
        }
        return static_cast<float>(surfaces * std::exp(-optical_depth));
    }

    std::size_t object_of(const float* entry) const {
        return std::min(static_cast<std::size_t>(entry[1]), sigma_.size() - 1);
    }

    static double fresnel_transmittance(float cosine) {
        const double grazing = 1.0 - static_cast<double>(cosine);
        return 1.0 - grazing * grazing * grazing * grazing * grazing;
    }

    static constexpr double outside = std::numeric_limits<double>::infinity();

    std::vector<double> sigma_; ///< of each object
    bool fresnel_;
};

pipeline::Frame build(const Scene& scene, const pipeline::View& view, const TranslucencyParams& params) {
    pipeline::Frame frame = frame_of(scene, view);
    frame.resolve =
        std::make_shared<const TranslucencyPicture>(extinctions(params, frame.draws.size()), params.fresnel);
    frame.program = models::make_nearest_k(entry_of(params), params.k);
    frame.background = {params.background[0], params.background[1], params.background[2], 1.0F};
    return kbuffer_frame(std::move(frame), pipeline::FragmentColour::cosine);
}

} // namespace

Workload translucency_workload() {
    Workload workload = make_workload<TranslucencyParams>(
        "translucency", "light of the background, absorbed along its way through the objects", build);
    workload.build = [build = std::move(workload.build)](const Scene& scene, const pipeline::View& view,
                                                         WorkloadOptions options) {
        as_list(options, "sigma");
        return build(scene, view, options);
    };
    return workload;
}

} // namespace traces
