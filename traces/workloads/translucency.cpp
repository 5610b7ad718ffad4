// Translucency: light from the background, absorbed inside the drawn objects.
//
// Source: Bavoil 2007, section 6.1.2 (specification 004, A12). Each draw is a homogeneous object with a closed surface.
// translucency_picture.hpp has the formulas.
#include "models/programs/nearest_k.hpp"
#include "sim/check.hpp"
#include "traces/workloads/methods.hpp"
#include "traces/workloads/translucency_picture.hpp"

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
    Composite composite = Composite::free;

    static constexpr auto fields() {
        using P = TranslucencyParams;
        return std::tuple(
            sim::field<&P::k>("surfaces kept per pixel").unit("surfaces").range(1, 64),
            sim::field<&P::sigma>("extinction in 1 / scene unit: one number, or a list with one for each draw")
                .range(0.0, 1e30),
            sim::field<&P::media>("draws: each draw is an object of its own, and an entry keeps which; one: all draws "
                                  "are the surface of one object, and an entry is a depth"),
            sim::field<&P::fresnel>("surfaces transmit less at grazing angles; entries then keep the cosine, too"),
            sim::field<&P::background>("linear RGB of the light behind everything").range(0.0F, 1.0F),
            composite_field<P>());
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

pipeline::Frame build(const Scene& scene, const pipeline::View& view, const TranslucencyParams& params) {
    pipeline::Frame frame = frame_of(scene, view);
    const Translucency objects(extinctions(params, frame.draws.size()), params.fresnel);
    frame.program = models::make_nearest_k(entry_of(params), params.k);
    frame.background = {params.background[0], params.background[1], params.background[2], 1.0F};
    return kbuffer_frame(frame, translucency_picture(objects), params.composite, pipeline::FragmentColour::cosine);
}

// The shader gives cosines as colours.
TruthMethod truth(const Scene&, const pipeline::Frame& frame, const TranslucencyParams& params) {
    const auto medium = std::make_shared<const Translucency>(extinctions(params, frame.draws.size()), params.fresnel);
    TruthMethod method;
    method.channels = {{"inside", "length"}};
    method.pixel = [medium](Rays& rays, const PixelSurfaces& surfaces, std::uint32_t x, std::uint32_t y,
                            TruthPicture& picture) {
        std::vector<TranslucentSurface> crossed;
        for (const FrameSurface& layer : surfaces.layers)
            crossed.push_back({layer.distance, layer.draw, layer.colour.r});
        const auto passage = medium->passage(crossed, rays.view_rays(), x, y);
        const std::size_t pixel = picture.pixel(x, y);
        picture.channels[0].set(pixel, passage.inside);
        picture.set_colour(pixel, glm::dvec3(glm::vec3(rays.frame().background)) * passage.transmittance);
    };
    return method;
}

} // namespace

Workload translucency_workload() {
    Workload workload =
        taking(make_workload<TranslucencyParams>(
                   "translucency", "light of the background, absorbed along its way through the objects", build, truth),
               as_list, "sigma");
    workload.quality = {{"k", {"2", "4", "8", "16", "32"}}};
    workload.examples = {{"truth", "gen:slabs --workload translucency --set workload.sigma=2 --check"}};
    return workload;
}

} // namespace traces
