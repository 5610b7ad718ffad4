// Soft shadows of a square light from a layered shadow map: the light's view fills a k-buffer with depths, which then
// become the map; the eye's view fills depth, positions and colours; a kernel over the screen computes what each
// visible point sees of the light.
//
// Source: Bavoil 2007, chapter 5 (specification 004, W5 and A17 to A25). There the layers are peeled in several passes
// (design `multipass`); any design that keeps nearest depths can capture them. Positions are unprojected from a 32-bit
// depth buffer and rounded to the format of the map, as the render target that held them was.
#include "models/programs/nearest_k.hpp"
#include "pipeline/functional/eye_depth.hpp"
#include "sim/check.hpp"
#include "traces/pass_graph.hpp"
#include "traces/shadows/shadow_shaders.hpp"
#include "traces/workloads/methods.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
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

/// The passes, in the order of section 2.6 of the specification.
class SoftShadowGraph {
  public:
    SoftShadowGraph(pipeline::Frame frame, const AreaLight& light, const SoftShadowParams& params)
        : params_(params),
          setup_{.eye = frame.view,
                 .light = light,
                 .map = map_options(params),
                 .kernel = kernel_options(params),
                 .ambient = params.ambient,
                 .background = glm::vec3(frame.background)},
          reads_(setup_),
          graph_(with_draws_for_light(std::move(frame))) {
        add_views();
        add_map();
        add_kernel();
    }

    pipeline::Frame lower() const { return graph_.lower(); }

  private:
    // Draws of their own for each view, so that reports tell them apart.
    pipeline::Frame with_draws_for_light(pipeline::Frame frame) {
        const auto draws = static_cast<std::uint32_t>(frame.draws.size());
        for (std::uint32_t i = 0; i < draws; ++i) {
            from_eye_.push_back(i);
            from_light_.push_back(draws + i);
            frame.draws.push_back(frame.draws[i]);
            frame.draws.back().name += " (light)";
        }
        return frame;
    }

    pipeline::SurfaceFormat format() const { return surface_format(params_.format); }

    /// Of the map, or a level of its hierarchy.
    void add_square(const std::string& name, std::uint32_t size, pipeline::SurfaceFormat format,
                    std::vector<pipeline::SurfacePicture> shown = {}) {
        graph_.add_surface({.name = name, .format = format, .width = size, .height = size, .shown = std::move(shown)});
    }

    void add_views() {
        graph_.add_clear("clear k-buffer", {kbuffer_surface});
        graph_.add_draw("light", {}, {kbuffer_surface}, from_light_, true);
        graph_.see_from(setup_.light.view(params_.map_size));
        graph_.leave_out("colours of the light's passes", "its layers are depths");
        graph_.add_surface(eye_colours, format()); // alpha is 0 where there is no surface
        graph_.add_surface(eye_places, format());
        graph_.add_clear("clear", {depth_surface, eye_colours});
        ShadedPass eye;
        eye.name = "eye";
        eye.shader = shadow_eye_shader(setup_.eye);
        eye.targets = {eye_colours, eye_places};
        eye.draws = from_eye_;
        eye.depth = depth_surface;
        eye.states[0].depth.test = eye.states[0].depth.write = true;
        graph_.add_shaded(std::move(eye));
    }

    void add_screen(std::string name, std::shared_ptr<const pipeline::Shader> shader, std::vector<std::string> reads,
                    std::vector<std::string> targets, bool timed = true) {
        ShadedPass pass;
        pass.name = std::move(name);
        pass.shader = std::move(shader);
        pass.reads = std::move(reads);
        pass.targets = std::move(targets);
        pass.screen = true;
        pass.timed = timed;
        graph_.add_shaded(std::move(pass));
    }

    static std::string layers_name(std::uint32_t pack) { return fmt::format("shadow map {}", pack); }
    static std::string slopes_name(std::uint32_t pack) { return fmt::format("slopes {}", pack); }
    /// The hierarchy begins with the map.
    std::string level_name(std::uint32_t level) const {
        return level == 0 ? layers_name(0) : fmt::format("least depths {}", params_.map_size >> level);
    }
    static std::vector<std::string> names(std::string (*name)(std::uint32_t), std::uint32_t count) {
        std::vector<std::string> all;
        for (std::uint32_t i = 0; i < count; ++i) all.push_back(name(i));
        return all;
    }

    void add_map() {
        const auto near = static_cast<float>(setup_.light.near), far = static_cast<float>(setup_.light.far);
        const std::vector<std::string> packs = names(layers_name, packs_of(params_.k)),
                                       slopes = names(slopes_name, packs_of(params_.layers));
        for (std::uint32_t pack = 0; pack < packs.size(); ++pack) {
            std::vector<pipeline::SurfacePicture> shown;
            for (std::uint32_t layer = 4 * pack; layer < std::min(4 * pack + 4, params_.k); ++layer)
                shown.push_back({fmt::format("light_layer{}", layer),
                                 fmt::format("distance of layer {} from the light", layer), layer % 4, near, far});
            add_square(packs[pack], params_.map_size, format(), std::move(shown));
        }
        add_screen("pack", shadow_pack_shader(setup_), {kbuffer_surface}, packs);
        std::vector<std::string> biased{packs[0]};
        if (setup_.map.gscale > 0.0F) {
            for (const std::string& name : slopes) add_square(name, params_.map_size, format());
            add_screen("slopes", shadow_slope_shader(setup_), {kbuffer_surface}, slopes);
            biased.push_back(slopes[0]);
        } else {
            leave_out("slopes", "no slope bias: gscale is 0",
                      slopes.size() * (map_bytes() + map_texels() * pipeline::target_pixel_bytes));
        }
        add_square("bias", params_.map_size, pipeline::SurfaceFormat::r32f,
                   {{"bias", "bias of layer 0", 0, 0.0F, (far - near) / 2.0F}});
        add_screen("bias", shadow_bias_shader(setup_), biased, {"bias"}, false);
        for (std::uint32_t level = 1; level <= reads_.levels; ++level) {
            add_square(level_name(level), params_.map_size >> level, format());
            add_screen(level_name(level), least_depth_shader(), {level_name(level - 1)}, {level_name(level)});
        }
        if (!setup_.map.hierarchy) // each level is written once and read once
            leave_out("least depths", "the search region is not narrowed: iterations is 0",
                      map_bytes() + 2 * (map_bytes() / 3));
    }

    void add_kernel() {
        std::vector<std::string> reads{eye_colours, eye_places};
        for (std::uint32_t pack = 0; pack < reads_.packs; ++pack) reads.push_back(layers_name(pack));
        for (std::uint32_t pack = 0; pack < reads_.slopes; ++pack) reads.push_back(slopes_name(pack));
        for (std::uint32_t level = 1; level <= reads_.levels; ++level) reads.push_back(level_name(level));
        add_picture("samples", pipeline::SurfaceFormat::r32f,
                    {"samples", "samples of the kernel", 0, 0.0F, static_cast<float>(params_.samples)});
        add_picture(picture_surface, pipeline::SurfaceFormat::rgba32f,
                    {"visibility", "what each point sees of the light", 3, 0.0F, 1.0F});
        add_screen("shadow kernel", shadow_kernel_shader(setup_), reads, {picture_surface});
        add_screen("samples", shadow_samples_shader(setup_), reads, {"samples"}, false);
        graph_.output(picture_surface);
    }

    void add_picture(const char* name, pipeline::SurfaceFormat format, pipeline::SurfacePicture shown) {
        graph_.add_surface({.name = name,
                            .format = format,
                            .width = setup_.eye.width,
                            .height = setup_.eye.height,
                            .shown = {std::move(shown)}});
    }

    std::uint64_t map_texels() const { return std::uint64_t{params_.map_size} * params_.map_size; }
    std::uint64_t map_bytes() const { return map_texels() * bytes_of(format()); }
    void leave_out(const char* pass, const char* reason, std::uint64_t bytes) {
        graph_.leave_out(fmt::format("pass {}", pass),
                         fmt::format("{}; saves {} bytes of memory traffic", reason, bytes));
    }

    static constexpr const char* eye_colours = "colours";
    static constexpr const char* eye_places = "positions";

    SoftShadowParams params_;
    ShadowSetup setup_;
    ShadowKernelReads reads_;
    std::vector<std::uint32_t> from_eye_, from_light_; ///< draws
    PassGraph graph_;
};

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
    frame.depth_format = pipeline::SurfaceFormat::d32f;
    frame.background = {params.background[0], params.background[1], params.background[2], 1.0F};
    return SoftShadowGraph(std::move(frame), light, params).lower();
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
