// Soft shadows of a square light from a layered shadow map: the light's view fills a k-buffer with depths, which then
// become the map; the eye's view fills depth, positions and colours; a kernel over the screen computes what each
// visible point sees of the light.
//
// Source: Bavoil 2007, chapter 5 (specification 004, W5 and A17 to A25). There the layers are peeled in several passes
// (design `multipass`); any design that keeps nearest depths can capture them. Positions are unprojected from a 32-bit
// depth buffer and rounded to the format of the map, as the render target that held them was.
#include "models/programs/nearest_k.hpp"
#include "pipeline/functional/fragment_operations.hpp"
#include "pipeline/functional/parallel.hpp"
#include "sim/check.hpp"
#include "traces/pass_graph.hpp"
#include "traces/screen_draw.hpp"
#include "traces/shadows/shadow_passes.hpp"
#include "traces/view_rays.hpp"
#include "traces/workloads/methods.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

namespace traces {

namespace {

constexpr const char* place = "workload soft-shadows";

struct SoftShadowParams {
    std::string light = "auto";
    double light_size = 0.15;
    std::uint32_t map_size = 1024;
    std::uint32_t k = 4;
    std::uint32_t layers = 3;
    ShadowFormat format = ShadowFormat::rgba16f;
    ShadowMethod method = ShadowMethod::layered;
    std::uint32_t samples = 441;
    std::uint32_t iterations = 2;
    SampleStep step = SampleStep::even;
    SampleOffset offset = SampleOffset::integer;
    ShadowBias bias = ShadowBias::midpoint;
    float uniform_bias = 0.0F;
    float gscale = 0.0F;
    float gmax = 0.0F;
    bool width_as_radius = false;
    bool jittered = false;
    bool gap_filling = false;
    std::uint32_t pcf_radius = 2;
    float ambient = 0.0F;
    std::array<float, 3> background = {1.0F, 1.0F, 1.0F};

    static constexpr auto fields() {
        using P = SoftShadowParams;
        return std::tuple(
            sim::field<&P::light>("auto: the first spot light, or one above the scene; or the number of a spot light; "
                                  "or px,py,pz,tx,ty,tz"),
            sim::field<&P::light_size>("edge of the light over its distance to the middle of the scene; 0: a point")
                .range(0.0, 10.0),
            sim::field<&P::map_size>("edge of the shadow map, a power of two").unit("texels").range(1, 8192),
            sim::field<&P::k>("layers captured").unit("layers").range(1, 16),
            sim::field<&P::layers>("layers that throw shadows, at most k").unit("layers").range(1, 16),
            sim::field<&P::format>("of depths, biases and positions"),
            sim::field<&P::method>("layered: back-projection; hard: one texel of the first layer; pcf: the share of a "
                                   "square of texels"),
            sim::field<&P::samples>("most samples of the kernel for a pixel (max_nspp)")
                .unit("samples")
                .range(1, 65025),
            sim::field<&P::iterations>("narrowings of the search region; 0: no hierarchy of least depths").range(0, 16),
            sim::field<&P::step>("between samples of a region with too many texels: even: the square root of the "
                                 "ratio; literal: the ratio"),
            sim::field<&P::offset>("of a sample from the projected point: integer: its number; exact: its texel's "
                                   "middle"),
            sim::field<&P::bias>("of each layer: none, uniform, midpoint (half way to the next), second_depth"),
            sim::field<&P::uniform_bias>("of bias = uniform; scene units").range(0.0F, 1e30F),
            sim::field<&P::gscale>("slope bias over the depth difference of a texel; 0: none").range(0.0F, 1e6F),
            sim::field<&P::gmax>("bound of the slope bias; 0: none; scene units").range(0.0F, 1e30F),
            sim::field<&P::width_as_radius>("takes the width of the search region for its radius"),
            sim::field<&P::jittered>("moves samples that skip texels, pixel by pixel"),
            sim::field<&P::gap_filling>("samples reach to their neighbours on the light"),
            sim::field<&P::pcf_radius>("of method = pcf: texels on either side").unit("texels").range(0, 127),
            sim::field<&P::ambient>("light that reaches points in full shadow").range(0.0F, 1.0F),
            sim::field<&P::background>("linear RGB behind everything").range(0.0F, 1.0F));
    }
};
static_assert(sim::fully_described<SoftShadowParams>);

ShadowMapOptions map_options(const SoftShadowParams& params) {
    return {.resolution = params.map_size,
            .captured = params.k,
            .layers = params.layers,
            .format = params.format,
            .bias = params.bias,
            .uniform_bias = params.uniform_bias,
            .gscale = params.gscale,
            .gmax = params.gmax,
            .hierarchy = params.iterations > 0 && params.method == ShadowMethod::layered};
}

ShadowKernelOptions kernel_options(const SoftShadowParams& params) {
    return {.method = params.method,
            .most_samples = params.samples,
            .iterations = params.iterations,
            .step = params.step,
            .offset = params.offset,
            .width_as_radius = params.width_as_radius,
            .jittered = params.jittered,
            .gap_filling = params.gap_filling,
            .pcf_radius = params.pcf_radius};
}

class ShadowPicture final : public pipeline::Resolve {
  public:
    ShadowPicture(const AreaLight& light, const SoftShadowParams& params)
        : light_(light), params_(params), map_options_(map_options(params)), kernel_options_(kernel_options(params)) {}

    /// Alpha is what each point sees of the light; 1 in the background.
    std::vector<float> picture(const pipeline::Frame& frame,
                               const pipeline::FinishedSurfaces& surfaces) const override {
        const ShadowMap map = map_of(frame, surfaces);
        const ShadowKernel kernel(map, kernel_options_);
        std::vector<float> picture(frame.view.pixels() * 4, 1.0F);
        for_each_point(frame, surfaces, [&](std::size_t pixel, const glm::dvec3& point) {
            const float visible = kernel.visibility(kernel.region(point), pixel);
            const float light = params_.ambient + (1.0F - params_.ambient) * visible;
            for (std::size_t channel = 0; channel < 3; ++channel)
                picture[pixel * 4 + channel] = light * surfaces.colour[pixel * 4 + channel];
            picture[pixel * 4 + 3] = visible;
        });
        for (std::size_t pixel = 0; pixel < frame.view.pixels(); ++pixel)
            if (!is_point(surfaces, pixel))
                for (int channel = 0; channel < 3; ++channel)
                    picture[pixel * 4 + static_cast<std::size_t>(channel)] = frame.background[channel];
        return picture;
    }

    std::vector<pipeline::ScreenPass> screen_passes(const pipeline::Frame& frame,
                                                    const pipeline::FinishedSurfaces& surfaces) const override {
        const ShadowMap map = map_of(frame, surfaces);
        const ShadowKernel kernel(map, kernel_options_);
        std::vector<KernelWork> work(frame.view.pixels());
        for_each_point(frame, surfaces, [&](std::size_t pixel, const glm::dvec3& point) {
            if (!is_black(surfaces, pixel)) work[pixel] = kernel_work(kernel.region(point));
        });
        return shadow_passes(setup(frame), work);
    }

    std::vector<pipeline::ResolveImage> images(const pipeline::Frame& frame, const pipeline::FinishedSurfaces& surfaces,
                                               std::span<const float> picture) const override {
        const ShadowMap map = map_of(frame, surfaces);
        std::vector<pipeline::ResolveImage> images;
        images.push_back(visibility_image(frame, picture));
        for (std::uint32_t layer = 0; layer < params_.k; ++layer) images.push_back(distance_image(map, layer));
        images.push_back(bias_image(map));
        images.push_back(region_image(frame, surfaces, map));
        return images;
    }

    ShadowPassSetup setup(const pipeline::Frame& frame) const {
        return {frame.view.width, frame.view.height, map_options_, kernel_options_};
    }

  private:
    ShadowMap map_of(const pipeline::Frame& frame, const pipeline::FinishedSurfaces& surfaces) const {
        return {light_, surfaces.kbuffer, frame.program->floats_per_pixel(), map_options_};
    }

    static bool is_point(const pipeline::FinishedSurfaces& surfaces, std::size_t pixel) {
        return surfaces.depth[pixel] < 1.0F;
    }
    static bool is_black(const pipeline::FinishedSurfaces& surfaces, std::size_t pixel) {
        const float* rgba = surfaces.colour.data() + pixel * 4;
        return rgba[0] <= 0.0F && rgba[1] <= 0.0F && rgba[2] <= 0.0F;
    }

    /// use(pixel, place in the world) for every pixel that shows a surface, in parallel by rows.
    template <class Use>
    void for_each_point(const pipeline::Frame& frame, const pipeline::FinishedSurfaces& surfaces, Use use) const {
        const ViewRays rays(frame.view);
        const glm::dmat4 to_world = glm::inverse(glm::dmat4(frame.view.view));
        pipeline::parallel_for(0, frame.view.height, [&](std::size_t row) {
            const auto y = static_cast<std::uint32_t>(row);
            for (std::uint32_t x = 0; x < frame.view.width; ++x) {
                const std::size_t pixel = row * frame.view.width + x;
                if (!is_point(surfaces, pixel)) continue;
                const glm::dvec3 eye = rays.place(x, y, rays.distance(surfaces.depth[pixel]));
                const glm::vec3 world(to_world * glm::dvec4(eye, 1.0));
                use(pixel, glm::dvec3(through_shadow_format(params_.format, world.x),
                                      through_shadow_format(params_.format, world.y),
                                      through_shadow_format(params_.format, world.z)));
            }
        });
    }

    static pipeline::ResolveImage visibility_image(const pipeline::Frame& frame, std::span<const float> picture) {
        pipeline::ResolveImage image{
            "visibility", "what each point sees of the light", frame.view.width, frame.view.height, {}, 0.0F, 1.0F};
        for (std::size_t pixel = 0; pixel < frame.view.pixels(); ++pixel)
            image.values.push_back(picture[pixel * 4 + 3]);
        return image;
    }

    static pipeline::ResolveImage distance_image(const ShadowMap& map, std::uint32_t layer) {
        const auto [low, high] = map.range();
        return map_image(map,
                         {fmt::format("light_layer{}", layer),
                          fmt::format("distance of layer {} from the light", layer),
                          0,
                          0,
                          {},
                          low,
                          high},
                         [layer](const ShadowMap& from, int x, int y) { return from.depth(layer, x, y); });
    }

    static pipeline::ResolveImage bias_image(const ShadowMap& map) {
        const auto [low, high] = map.range();
        return map_image(
            map, {"bias", "bias of layer 0", 0, 0, {}, 0.0F, (high - low) / 2.0F},
            [](const ShadowMap& from, int x, int y) { return from.empty(0, x, y) ? 0.0F : from.bias(0, x, y); });
    }

    template <class Value>
    static pipeline::ResolveImage map_image(const ShadowMap& map, pipeline::ResolveImage image, Value value) {
        image.width = image.height = map.options().resolution;
        const auto r = static_cast<int>(image.width);
        for (int y = 0; y < r; ++y)
            for (int x = 0; x < r; ++x) image.values.push_back(value(map, x, y));
        return image;
    }

    pipeline::ResolveImage region_image(const pipeline::Frame& frame, const pipeline::FinishedSurfaces& surfaces,
                                        const ShadowMap& map) const {
        const ShadowKernel kernel(map, kernel_options_);
        pipeline::ResolveImage image{"samples",
                                     "samples of the kernel",
                                     frame.view.width,
                                     frame.view.height,
                                     std::vector<float>(frame.view.pixels()),
                                     0.0F,
                                     static_cast<float>(params_.samples)};
        for_each_point(frame, surfaces, [&](std::size_t pixel, const glm::dvec3& point) {
            const std::uint32_t across = is_black(surfaces, pixel) ? 0 : kernel.region(point).across;
            image.values[pixel] = static_cast<float>(across * across);
        });
        return image;
    }

    AreaLight light_;
    SoftShadowParams params_;
    ShadowMapOptions map_options_;
    ShadowKernelOptions kernel_options_;
};

void check(const SoftShadowParams& params, const pipeline::View& view) {
    if (!std::has_single_bit(params.map_size))
        throw sim::InputError(fmt::format("{}: map_size: expected a power of two, got {}", place, params.map_size));
    if (params.layers > params.k)
        throw sim::InputError(
            fmt::format("{}: layers: expected at most k = {}, got {}", place, params.k, params.layers));
    if (view.samples != 1)
        throw sim::InputError(
            fmt::format("--samples: expected 1 with workload soft-shadows, whose kernel runs once for a pixel, got {}",
                        view.samples));
    if (!pipeline::EyeDepth(view.projection).perspective())
        throw sim::InputError(fmt::format("{}: expected a perspective camera, got a parallel projection", place));
}

/// Why 16-bit floats cannot hold distances from the light and places in the scene; nothing where they can. A place that
/// is off by a 256th of the scene is in the shadow of something else.
std::optional<std::string> too_large_for_halves(const Scene& scene, const AreaLight& light) {
    constexpr double largest = 65504.0, least_step = 0x1p-24, steps = 256.0;
    const glm::dvec3 extent = glm::max(glm::abs(glm::dvec3(scene.lo)), glm::abs(glm::dvec3(scene.hi)));
    const double place_of_corner = std::max({extent.x, extent.y, extent.z});
    const double farthest = std::max(place_of_corner, light.far);
    if (farthest > largest) return fmt::format("numbers up to {:.6g} are above 65504", farthest);
    const double step = std::max(least_step, std::exp2(std::floor(std::log2(place_of_corner)) - 10.0));
    const double radius = static_cast<double>(scene.radius);
    if (step * steps > radius)
        return fmt::format("places up to {:.6g} have steps of {:.3g}, too coarse for a scene of radius {:.3g}",
                           place_of_corner, step, radius);
    return std::nullopt;
}

pipeline::Frame build(const Scene& scene, const pipeline::View& view, const SoftShadowParams& asked_for) {
    SoftShadowParams params = asked_for;
    check(params, view);
    const AreaLight light = make_area_light(scene, params.light, params.light_size, place);
    pipeline::Frame frame = frame_of(scene, view);
    if (params.format == ShadowFormat::rgba16f)
        if (const auto reason = too_large_for_halves(scene, light)) {
            params.format = ShadowFormat::rgba32f;
            frame.notes.push_back(
                fmt::format("format rgba16f cannot hold the scene, rgba32f is taken in its place: {}", *reason));
        }
    frame.program = models::make_nearest_k(models::EntryKind::z, params.k);
    const auto picture = std::make_shared<const ShadowPicture>(light, params);
    frame.resolve = picture;
    frame.depth_format = pipeline::SurfaceFormat::d32f;
    frame.colour_format =
        params.format == ShadowFormat::rgba16f ? pipeline::SurfaceFormat::rgba16f : pipeline::SurfaceFormat::rgba32f;
    frame.background = {params.background[0], params.background[1], params.background[2], 1.0F};
    // Draws of their own for each view, so that reports tell them apart.
    const auto draws = static_cast<std::uint32_t>(frame.draws.size());
    for (std::uint32_t i = 0; i < draws; ++i) {
        frame.draws.push_back(frame.draws[i]);
        frame.draws.back().name += " (light)";
    }
    std::vector<std::uint32_t> eye(draws), from_light(draws);
    std::iota(eye.begin(), eye.end(), 0U);
    std::iota(from_light.begin(), from_light.end(), draws);
    add_screen_draw(frame);

    PassGraph graph(std::move(frame));
    graph.add_clear("clear k-buffer", {kbuffer_surface});
    graph.add_draw("light", {}, {kbuffer_surface}, std::move(from_light), true);
    graph.see_from(light.view(params.map_size));
    graph.add_clear("clear", {depth_surface, colour_surface});
    graph.add_draw("eye", {depth_surface}, {depth_surface, colour_surface}, std::move(eye));
    graph.write_targets(2); // colours, and positions
    graph.add_resolve("shadows", {kbuffer_surface, depth_surface, colour_surface}, {picture_surface});
    graph.output(picture_surface);
    graph.leave_out("colours of the light's passes", "its layers are depths");
    pipeline::Frame result = graph.lower();
    for (const SavedPass& saved : saved_passes(picture->setup(result)))
        result.left_out.push_back({fmt::format("pass {}", saved.name),
                                   fmt::format("{}; saves {} bytes of memory traffic", saved.reason, saved.bytes)});
    return result;
}

// What is lit follows from the surfaces that the eye sees, whatever the shadows' method.
TruthMethod truth(const Scene& scene, const pipeline::Frame& frame, const SoftShadowParams& params) {
    TruthMethod method = layered_truth();
    method.frame = std::make_shared<const pipeline::Frame>(build_frame(scene, frame.view, opaque_workload()));
    method.light = make_area_light(scene, params.light, params.light_size, place).square();
    method.key = "";
    return method;
}

// Hard shadows of many point lights that share the area of one, each with its own map and its own kernel: what soft
// shadow maps compete with. Source: Bavoil 2007, sections 1.2 and 5.1 (specification 004, section 3.5: more than a
// hundred passes before banding disappears).
std::vector<std::vector<std::string>> hard_shadows(const Scene& scene, const pipeline::Frame& frame,
                                                   const WorkloadOptions& given, std::uint32_t count) {
    WorkloadOptions options = given;
    as_text(options, "light");
    const auto params = read_parameters<SoftShadowParams>(options.values, place);
    const SquareLight light = make_area_light(scene, params.light, params.light_size, place).square();
    const glm::dvec3 forward = -glm::dvec3(glm::inverse(glm::dmat4(frame.view_of_kbuffer().view))[2]);
    std::vector<std::string> shared{"method=hard", "light_size=0", "layers=1", "k=2"};
    for (const char* key : {"map_size", "format", "bias", "uniform_bias", "gscale", "gmax"}) // what one layer knows
        if (const auto value = options.values->find(key); value != options.values->end())
            shared.push_back(fmt::format("{}={}", key, value->is_string() ? value->get<std::string>() : value->dump()));
    std::vector<std::vector<std::string>> frames(count, shared);
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::dvec3 at = spread_over(light, i, count), target = at + forward;
        frames[i].push_back(fmt::format("light={},{},{},{},{},{}", at.x, at.y, at.z, target.x, target.y, target.z));
    }
    return frames;
}

} // namespace

Workload soft_shadows_workload() {
    Workload workload =
        taking(make_workload<SoftShadowParams>(
                   "soft-shadows", "shadows of a square light from a layered shadow map, captured by a k-buffer", build,
                   truth),
               as_text, "light");
    workload.measured = Measured::light;
    workload.quality = {{"layers", {"1", "2", "3"}},
                        {"map_size", {"256", "512", "1024", "2048"}},
                        {"samples", {"9", "49", "169", "289", "441", "961", "1089"}},
                        {"iterations", {"0", "1", "2"}},
                        {"gscale", {"0", "1", "4", "10"}},
                        {"format", {"rgba16f", "rgba32f"}},
                        {"method", {"layered", "hard", "pcf"}}};
    workload.averaging = Averaging{"hard shadows", {"clear", "eye"}, hard_shadows};
    workload.options = {{"light", "LIGHT",
                         "Square light of soft-shadows: auto, the number of a spot light of the scene, or "
                         "px,py,pz,tx,ty,tz (place and target)"}};
    workload.examples = {
        {"accuracy", "scene.glb+ground --workload soft-shadows --out accuracy"},
        {"accuracy", "scene.glb+ground --workload soft-shadows --sweep layers=1,2,3 --sweep samples=169,441"},
        {"accuracy", "scene.glb+ground --workload soft-shadows --against 'layers=3 samples=1089'"}};
    return workload;
}

} // namespace traces
