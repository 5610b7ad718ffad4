// Deferred shading of one transparent layer with coloured shadows and refraction.
//
// Method pm: rows of one G-buffer take turns, opaque surfaces alone and the nearest of all, so that one geometry pass
// holds a pane and what lies behind it at half the rows; shadow maps do the same; a pass over the screen takes the rows
// apart. Method dp: a second G-buffer is peeled behind the first, both at full resolution, both lit.
// Methods fwd and fw: forward rendering, the geometry once more for each light, rows as in pm; with and without depths.
// Method kg: the G-buffer is a k-buffer, which keeps of each pixel what dp peels, in one geometry pass. Shadow maps can
// be k-buffers, too.
// Source: Aladağlı 2015 (specification 003, sections 1.1 to 1.6; 5 for kg).
#include "models/programs/two_class.hpp"
#include "pipeline/fragment_stream.hpp"
#include "pipeline/functional/eye_depth.hpp"
#include "sim/check.hpp"
#include "traces/deferred/shaders.hpp"
#include "traces/deferred/truth.hpp"
#include "traces/pass_graph.hpp"
#include "traces/workloads/deferred_params.hpp"
#include "traces/workloads/methods.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <numeric>

namespace traces {

namespace {

constexpr const char* workload_deferred = "workload deferred";

void check(const Scene& scene, const pipeline::View& view) {
    if (scene.screen_space)
        throw sim::InputError(fmt::format("{}: expected a scene with places in a world, those of {} are on the screen",
                                          workload_deferred, scene.name));
    if (view.samples != 1)
        throw sim::InputError(fmt::format(
            "--samples: expected 1 with workload deferred, whose rows are told apart by number, got {}", view.samples));
    if (!pipeline::EyeDepth(view.projection).perspective())
        throw sim::InputError(
            fmt::format("{}: expected a perspective camera, got a parallel projection", workload_deferred));
}

/// The names of a G-buffer's surfaces and of the light on them.
struct GBuffer {
    std::string colours, normals, specular, depths, light;

    explicit GBuffer(const std::string& which)
        : colours("colours" + which),
          normals("normals" + which),
          specular("specular" + which),
          depths("depths" + which),
          light("light" + which) {}
    std::vector<std::string> targets() const { return {colours, normals, specular, depths}; }
};

class DeferredGraph {
  public:
    DeferredGraph(const Scene& scene, pipeline::Frame frame, const DeferredParams& params)
        : params_(params), eye_(frame.view), all_(frame.draws.size()), lights_(spot_lights(scene, params.lights)) {
        std::iota(all_.begin(), all_.end(), 0U);
        volumes_ = add_light_volumes(frame, lights_);
        frame_ = frame;
        materials_ = std::make_shared<const MaterialReads>(frame_, CommonShine{params.specular, params.specular_power},
                                                           params.maps);
        if (const std::uint32_t draws = materials_->without_coordinates(); draws != 0)
            frame.notes.push_back(fmt::format("maps of materials: {} draws have none of the coordinates that one asks "
                                              "for, and are drawn without it",
                                              draws));
        graph_.emplace(std::move(frame));
        for (const pipeline::SurfaceInfo& map : materials_->surfaces()) graph_->add_surface(map);
        build();
    }

    pipeline::Frame lower() const { return graph_->lower(); }

  private:
    bool forward() const { return params_.method == DeferredMethod::fw || params_.method == DeferredMethod::fwd; }
    bool stores_depths() const { return params_.method == DeferredMethod::fwd; }
    bool keeps_classes() const { return params_.method == DeferredMethod::kg; }
    bool shadow_kbuffer() const {
        return params_.shadows == Shadows::transparent && params_.shadow_maps == ShadowMaps::two_class;
    }
    LightOptions light_options() const {
        return {params_.shadows, params_.shadow_maps, params_.map_size, params_.bias, params_.intensity};
    }
    /// Both surfaces of a pixel are lit.
    bool lights_both() const { return peels() || keeps_classes(); }
    bool peels() const { return params_.method == DeferredMethod::dp; }

    void build() {
        if (forward())
            add_ambient();
        else if (keeps_classes())
            add_two_class_gbuffer();
        else
            add_gbuffer(nearest_, peels() ? Layer::nearest : Layer::interlaced, "G-buffer");
        if (peels()) add_gbuffer(behind_, Layer::behind, "G-buffer behind");
        graph_->add_surface("shadow depths", pipeline::SurfaceFormat::r32f, glm::vec4(1.0F));
        graph_->add_surface("shadow colours", pipeline::SurfaceFormat::rgba8, glm::vec4(0, 0, 0, 1));
        graph_->add_surface("shadow z", pipeline::SurfaceFormat::d24);
        const glm::vec4 ambient(glm::vec3(params_.ambient), 0.0F);
        graph_->add_surface(nearest_.light, pipeline::SurfaceFormat::rgba8, ambient);
        graph_->add_surface(behind_.light, pipeline::SurfaceFormat::rgba8, ambient);
        if (!forward())
            graph_->add_clear("clear light",
                              lights_both() ? std::vector{nearest_.light, behind_.light} : std::vector{nearest_.light});
        for (std::size_t i = 0; i < lights_.size(); ++i) {
            if (params_.shadows != Shadows::none) add_shadow_map(i);
            forward() ? add_forward_light(i) : add_light(i, nearest_, fmt::format("light {}", i));
            if (peels()) add_light(i, behind_, fmt::format("light {} behind", i));
        }
        add_composition();
        graph_->output("picture");
    }

    void add_gbuffer(const GBuffer& names, Layer layer, const std::string& name) {
        graph_->add_surface(names.colours, pipeline::SurfaceFormat::rgba8, glm::vec4(0, 0, 0, 1));
        graph_->add_surface(names.normals, pipeline::SurfaceFormat::rgb10a2, glm::vec4(0.5F, 0.5F, 0.5F, 0.0F));
        graph_->add_surface(names.specular, pipeline::SurfaceFormat::rgba8);
        graph_->add_surface(names.depths, pipeline::SurfaceFormat::r32f, glm::vec4(1.0F));
        std::vector<std::string> cleared = names.targets();
        cleared.emplace_back(depth_surface);
        graph_->add_clear("clear " + name, std::move(cleared));
        ShadedPass pass;
        pass.name = name;
        pass.shader = gbuffer_shader(frame_, materials_, layer);
        if (layer == Layer::behind) pass.reads = {nearest_.depths};
        read_maps(pass);
        pass.targets = names.targets();
        pass.draws = all_;
        pass.depth = depth_surface;
        pass.states[0].depth.test = pass.states[0].depth.write = true;
        graph_->add_shaded(std::move(pass));
    }

    void add_two_class_gbuffer() {
        graph_->add_clear("clear G-buffer", {kbuffer_surface});
        ShadedPass pass;
        pass.name = "G-buffer";
        pass.shader = two_class_gbuffer_shader(frame_, materials_);
        read_maps(pass);
        pass.draws = all_;
        pass.kbuffer = kbuffer_surface;
        graph_->add_shaded(std::move(pass));
    }

    void add_ambient() {
        graph_->add_surface(nearest_.colours, pipeline::SurfaceFormat::rgba8, glm::vec4(0, 0, 0, 1));
        graph_->add_surface(nearest_.normals, pipeline::SurfaceFormat::rgb10a2, glm::vec4(0.5F, 0.5F, 0.5F, 0.0F));
        graph_->add_surface(nearest_.depths, pipeline::SurfaceFormat::r32f, glm::vec4(1.0F));
        std::vector<std::string> targets{nearest_.colours, nearest_.normals};
        if (stores_depths()) targets.push_back(nearest_.depths);
        std::vector<std::string> cleared = targets;
        cleared.emplace_back(depth_surface);
        graph_->add_clear("clear", std::move(cleared));
        ShadedPass pass;
        pass.name = "ambient";
        pass.shader = ambient_shader(frame_, materials_, params_.ambient, stores_depths());
        read_maps(pass);
        pass.targets = std::move(targets);
        pass.draws = all_;
        pass.depth = depth_surface;
        pass.states[0].depth.test = pass.states[0].depth.write = true;
        graph_->add_shaded(std::move(pass));
    }

    // All surfaces once more; what the ambient pass left nearest is lit, and keeps its opacity. Where several surfaces
    // have one depth, each passes the test and adds its light (specification 003, section 1.7: a blend per fragment),
    // unless the stencil holds the number of this light already.
    void add_forward_light(std::size_t light) {
        ShadedPass pass;
        pass.name = fmt::format("light {}", light);
        pass.shader = forward_light_shader(frame_, materials_, lights_[light], light_options());
        pass.reads = shadow_maps();
        read_maps(pass);
        pass.targets = {nearest_.colours};
        pass.draws = all_;
        pass.depth = depth_surface;
        pipeline::RasterState& state = pass.states[0];
        state.depth.test = true;
        state.depth.compare = pipeline::Compare::less_equal;
        if (params_.lit_once) {
            state.stencil.test = true;
            state.stencil.front.compare = pipeline::Compare::not_equal;
            state.stencil.front.reference = static_cast<std::uint8_t>(light + 1);
            state.stencil.front.passes = pipeline::StencilOperation::replace;
            state.stencil.back = state.stencil.front;
        }
        state.blend[0] = pipeline::blends::of(pipeline::blends::sum);
        state.write_mask[0] = 0b0111;
        graph_->add_shaded(std::move(pass));
    }

    std::vector<std::string> shadow_maps() const {
        if (shadow_kbuffer()) return {kbuffer_surface};
        std::vector<std::string> maps;
        if (params_.shadows != Shadows::none) maps.emplace_back("shadow depths");
        if (params_.shadows == Shadows::transparent) maps.emplace_back("shadow colours");
        return maps;
    }

    // One map serves all lights, one after the other.
    void add_shadow_map(std::size_t light) {
        std::vector<std::string> cleared = shadow_maps();
        if (!shadow_kbuffer()) cleared.emplace_back("shadow z");
        graph_->add_clear(fmt::format("clear shadow {}", light), std::move(cleared));
        ShadedPass pass;
        pass.name = fmt::format("shadow {}", light);
        pass.draws = all_;
        pass.states[0].depth.bias_slope = params_.slope_bias;
        if (shadow_kbuffer()) {
            pass.shader = two_class_shadow_shader(frame_);
            pass.kbuffer = kbuffer_surface;
        } else {
            pass.shader = shadow_shader(frame_, params_.shadows);
            pass.targets = shadow_maps();
            pass.depth = "shadow z";
            pass.states[0].depth.test = pass.states[0].depth.write = true;
        }
        pass.view = lights_[light].view(params_.map_size);
        graph_->add_shaded(std::move(pass));
    }

    // Front faces are left out where the eye is within the volume, as they lie behind it.
    void add_light(std::size_t light, const GBuffer& lit, std::string name) {
        ShadedPass pass;
        pass.name = std::move(name);
        if (keeps_classes()) {
            pass.shader = two_class_light_shader(eye_, lights_[light], light_options());
            pass.reads = {kbuffer_surface};
            pass.targets = {nearest_.light, behind_.light};
        } else {
            pass.shader = light_shader(eye_, lights_[light], light_options());
            pass.reads = {lit.normals, lit.specular, lit.depths};
            pass.targets = {lit.light};
        }
        for (std::string& map : shadow_maps()) pass.reads.push_back(std::move(map));
        pass.draws = {volumes_[light]};
        pipeline::RasterState& state = pass.states[0];
        state.blend.fill(pipeline::blends::of(pipeline::blends::sum));
        state.depth.clamp = true;
        state.culling = eye_touches(lights_[light]) ? pipeline::FaceCulling::front : pipeline::FaceCulling::back;
        graph_->add_shaded(std::move(pass));
    }

    bool eye_touches(const SpotLight& light) const {
        const glm::dvec4 corner = glm::inverse(glm::dmat4(eye_.projection)) * glm::dvec4(1.0, 1.0, -1.0, 1.0);
        return light.touches(glm::dvec3(glm::inverse(glm::dmat4(eye_.view))[3]),
                             glm::length(glm::dvec3(corner) / corner.w));
    }

    void add_composition() {
        graph_->add_surface("picture", pipeline::SurfaceFormat::rgba8);
        ShadedPass pass;
        pass.name = "composition";
        pass.screen = true;
        pass.targets = {"picture"};
        const bool glowing = materials_->glows() && !forward();
        const CompositionOptions options{params_.refraction, params_.refraction_coefficient, glowing};
        pass.reads = {nearest_.colours, nearest_.light};
        if (keeps_classes()) {
            pass.shader = two_class_composition(eye_, options);
            pass.reads = {kbuffer_surface, nearest_.light, behind_.light};
        } else if (peels()) {
            pass.shader = peeled_composition(eye_, options);
            pass.reads = {nearest_.colours, nearest_.light, nearest_.normals, nearest_.depths,
                          behind_.colours,  behind_.light,  behind_.depths};
            if (glowing) pass.reads.insert(pass.reads.end(), {nearest_.specular, behind_.specular});
        } else if (forward()) {
            pass.shader = interlaced_composition(eye_, options,
                                                 stores_depths() ? Interlaced::forward_depths : Interlaced::forward);
            pass.reads = {nearest_.colours};
            if (params_.refraction) pass.reads.push_back(nearest_.normals);
            if (params_.refraction && stores_depths()) pass.reads.push_back(nearest_.depths);
        } else {
            pass.shader = interlaced_composition(eye_, options);
            if (params_.refraction) pass.reads.insert(pass.reads.end(), {nearest_.normals, nearest_.depths});
            if (glowing) pass.reads.push_back(nearest_.specular);
        }
        graph_->add_shaded(std::move(pass));
    }

    void read_maps(ShadedPass& pass) const {
        for (const pipeline::SurfaceInfo& map : materials_->surfaces()) pass.reads.push_back(map.name);
    }

    DeferredParams params_;
    pipeline::View eye_;
    std::vector<std::uint32_t> all_, volumes_;
    std::vector<SpotLight> lights_;
    pipeline::Frame frame_;
    SharedMaterials materials_;
    std::optional<PassGraph> graph_;
    GBuffer nearest_{""}, behind_{" behind"};
};

// The texels of a map are made as they are drawn to, but all fragments of all passes are held at once.
void note_large_maps(const DeferredParams& params, pipeline::Frame& frame) {
    constexpr std::uint32_t ordinary = 2048;
    if (params.map_size <= ordinary || params.lights == 0 || params.shadows == Shadows::none) return;
    // A quad with its depths; colours that the shader is given and makes, which opaque shadows have no use for.
    const std::uint64_t values = params.shadows == Shadows::opaque ? 1 : 3;
    const std::uint64_t quads = std::uint64_t{params.map_size} * params.map_size / 4;
    const std::uint64_t bytes =
        quads * (sizeof(pipeline::Quad) + sizeof(pipeline::Lanes) + values * sizeof(pipeline::QuadTexels));
    frame.notes.push_back(
        fmt::format("shadow maps of {0}x{0} texels: the fragments of each light take up to {1} MiB of "
                    "memory for every layer of surfaces in its map",
                    params.map_size, bytes >> 20U));
}

pipeline::Frame build(const Scene& scene, const pipeline::View& view, const DeferredParams& params) {
    check(scene, view);
    pipeline::Frame frame = frame_of(scene, view);
    frame.background = glm::vec4(0, 0, 0, 1);
    const bool forward = params.method == DeferredMethod::fw || params.method == DeferredMethod::fwd;
    if (params.lit_once && forward) frame.depth_format = pipeline::SurfaceFormat::d24s8;
    const bool shadow_kbuffer =
        params.shadows == Shadows::transparent && params.shadow_maps == ShadowMaps::two_class && params.lights != 0;
    if (shadow_kbuffer && params.method == DeferredMethod::kg)
        throw sim::InputError(fmt::format("{}: shadow_maps: expected rows with method kg, whose G-buffer is the "
                                          "frame's k-buffer, got two-class",
                                          workload_deferred));
    if (shadow_kbuffer || params.method == DeferredMethod::kg) frame.program = models::make_two_class();
    const bool smooth = std::all_of(frame.draws.begin(), frame.draws.end(), [&](const pipeline::Draw& draw) {
        return frame.resources->geometries[draw.geometry].find(pipeline::Semantic::normal) != nullptr;
    });
    if (!smooth) frame.notes.emplace_back("some draws have no normals: those of their triangles are taken");
    const auto spots = static_cast<std::size_t>(std::count_if(
        scene.lights.begin(), scene.lights.end(), [](const Light& light) { return light.kind == LightKind::spot; }));
    if (const std::size_t taken = std::min<std::size_t>(spots, params.lights); taken != scene.lights.size())
        frame.notes.push_back(fmt::format("{} of the scene's {} lights shine: spots only, and as many as asked for",
                                          taken, scene.lights.size()));
    note_large_maps(params, frame);
    if (params.lights == 0) frame.notes.emplace_back("no lights: surfaces are seen in the ambient light alone");
    return DeferredGraph(scene, std::move(frame), params).lower();
}

TruthMethod truth(const Scene& scene, const pipeline::Frame& frame, const DeferredParams& params) {
    TruthMethod method = deferred_truth(scene, frame,
                                        {spot_lights(scene, params.lights),
                                         params.shadows,
                                         params.truth_filter,
                                         {params.refraction, params.refraction_coefficient},
                                         params.intensity,
                                         static_cast<double>(params.ambient),
                                         static_cast<double>(params.specular),
                                         static_cast<double>(params.specular_power),
                                         params.maps});
    DeferredParams known = params; // without what rays have no use for
    const DeferredParams usual;
    known.method = usual.method;
    known.map_size = usual.map_size;
    known.bias = usual.bias;
    known.slope_bias = usual.slope_bias;
    known.lit_once = usual.lit_once;
    method.key = key_of(sim::DescribedRef(known));
    return method;
}

} // namespace

Workload deferred_workload() {
    Workload workload = make_workload<DeferredParams>(
        "deferred", "deferred shading of one transparent layer, with coloured shadows and refraction", build, truth);
    workload.reads_maps = true;
    workload.quality = {{"method", {"pm", "dp", "fwd", "fw", "kg"}},
                        {"map_size", {"256", "512", "1024", "2048"}},
                        {"shadows", {"none", "opaque", "transparent"}},
                        {"refraction", {"false", "true"}}};
    workload.examples = {{"truth", "gen:showroom --workload deferred --check --out truth"},
                         {"accuracy", "gen:showroom --workload deferred --sweep method=pm,dp,fwd,fw,kg --out accuracy"},
                         {"accuracy", "gen:showroom --workload deferred --set workload.truth_filter=product"}};
    return workload;
}

} // namespace traces
