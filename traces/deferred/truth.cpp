#include "traces/deferred/truth.hpp"

#include "pipeline/functional/eye_depth.hpp"
#include "traces/deferred/reflection.hpp"
#include "traces/deferred/shadow_filter.hpp"
#include "traces/deferred/world_normals.hpp"
#include "traces/pass_graph.hpp"
#include "traces/workloads/methods.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

namespace traces {

namespace {

constexpr double index_of_glass = 1.5;
enum Channel : std::size_t { opaque_channel, transparent_channel, reflection_channel };

/// Colours of opaque fragments. It reads normals for the rays, which shade what the frame's shaders read.
class OpaqueShader final : public pipeline::Shader {
  public:
    OpaqueShader(const pipeline::Frame& frame, bool map_texcoords)
        : draws_(deferred_draws(frame)), map_texcoords_(map_texcoords) {}

    pipeline::ShaderShape shape() const override {
        return {.colour = pipeline::FragmentColour::unlit, .normal = true, .map_texcoords = map_texcoords_};
    }
    void shade(const pipeline::ShaderInput& input, pipeline::SurfaceAccess&,
               pipeline::ShaderOutput& output) const override {
        output.colours[0] = with_opacity(input.colour, draws_[input.draw]);
        output.alive &= ~transparent_pixels(output.colours[0]);
    }

  private:
    std::vector<DeferredDraw> draws_;
    bool map_texcoords_;
};

/// The surfaces of the scene alone, without volumes of lights; rasterized, its depths are those of opaque ones.
pipeline::Frame frame_of_surfaces(pipeline::Frame frame, const pipeline::Frame& of_workload, bool map_texcoords) {
    frame.workload = of_workload.workload;
    frame.background = of_workload.background;
    frame.depth_format = pipeline::SurfaceFormat::d32f;
    ShadedPass pass;
    pass.name = "opaque surfaces";
    pass.shader = std::make_shared<const OpaqueShader>(frame, map_texcoords);
    pass.targets = {colour_surface};
    pass.depth = depth_surface;
    pass.draws.resize(frame.draws.size());
    std::iota(pass.draws.begin(), pass.draws.end(), 0U);
    pass.states[0].depth.test = pass.states[0].depth.write = true;
    PassGraph graph(std::move(frame));
    graph.add_clear("clear", {depth_surface, colour_surface});
    graph.add_shaded(std::move(pass));
    graph.output(colour_surface);
    graph.output(depth_surface);
    return graph.lower();
}

std::vector<std::optional<double>> opaque_distances(const pipeline::Frame& frame,
                                                    const pipeline::ReferenceImage& reference) {
    const pipeline::EyeDepth eye(frame.view.projection);
    std::vector<std::optional<double>> distances;
    distances.reserve(reference.depth.size());
    for (const float window : reference.depth)
        distances.push_back(window < 1.0F ? std::optional(eye.distance(window)) : std::nullopt);
    return distances;
}

class TracedPicture {
  public:
    TracedPicture(const pipeline::Frame& surfaces, DeferredTruth options, SharedMaterials materials)
        : options_(std::move(options)),
          materials_(std::move(materials)),
          maps_(materials_->surfaces()),
          slots_(materials_->count()),
          draws_(deferred_draws(surfaces)),
          background_(surfaces.background),
          to_eye_(glm::dmat4(surfaces.view.view)),
          eye_(glm::inverse(glm::dmat4(surfaces.view.view))[3]),
          size_(surfaces.view.width, surfaces.view.height) {
        std::iota(slots_.begin(), slots_.end(), 0U);
    }

    bool is_opaque(const FrameSurface& surface) const { return !is_transparent(opacity(surface)); }

    void make(Rays& rays, const PixelSurfaces& seen, const glm::ivec2& at, TruthPicture& picture) const {
        const std::size_t pixel = picture.pixel(static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y));
        if (seen.has_opaque) picture.channels[opaque_channel].set(pixel, seen.opaque.distance);
        if (seen.layers.empty())
            return picture.set_colour(pixel, shown(seen.has_opaque ? lit(rays, seen.opaque, at) : background_));
        const FrameSurface& pane = seen.layers.front();
        picture.channels[transparent_channel].set(pixel, pane.distance);
        picture.channels[reflection_channel].set(pixel, reflects_totally(rays, pane, at) ? 1.0 : 0.0);
        const glm::dvec3 behind = behind_pane(rays, pane, seen, at);
        picture.set_colour(pixel, shown(laid_over(behind, lit(rays, pane, at), static_cast<double>(opacity(pane)))));
    }

  private:
    static glm::dvec3 shown(const glm::dvec3& colour) { return glm::min(colour, glm::dvec3(1.0)); }
    static glm::dvec3 place(const Rays& rays, const FrameSurface& surface, const glm::ivec2& at) {
        return rays.place(static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y), surface.distance);
    }

    float opacity(const FrameSurface& surface) const { return surface.colour.a * draws_[surface.draw].opacity; }

    struct Reflecting {
        glm::dvec3 normal{0.0};
        double specular = 0.0, power = 0.0;
        glm::dvec3 emission{0.0};
    };
    Reflecting material_of(const FrameSurface& surface) const {
        Reflecting of{surface.normal, options_.specular, options_.specular_power};
        if (materials_->stated(surface.draw)) {
            pipeline::ShaderInput input;
            input.pixels = 1U << surface.lane;
            input.draw = surface.draw;
            input.normal[surface.lane] = glm::vec4(glm::vec3(surface.normal), 0.0F);
            input.texcoords = surface.texcoords;
            input.tangent = surface.tangent;
            pipeline::SurfaceAccess access(maps_, slots_);
            const MaterialReads::Quad quad = materials_->read(
                input, access, 0, MaterialReads::normals | MaterialReads::shine | MaterialReads::emission);
            if (materials_->tilts(surface.draw)) of.normal = glm::dvec3(glm::vec3(quad.normals[surface.lane]));
            of.specular = static_cast<double>(quad.shine[surface.lane].x);
            of.power = static_cast<double>(quad.shine[surface.lane].y);
            of.emission = glm::dvec3(quad.emission[surface.lane]);
        }
        if (draws_[surface.draw].turned_over(surface.front)) of.normal = -of.normal;
        return of;
    }

    glm::dvec3 lit(Rays& rays, const FrameSurface& surface, const glm::ivec2& at) const {
        const Reflecting of = material_of(surface);
        const ReflectingPoint point{place(rays, surface, at), of.normal, of.specular, of.power};
        glm::dvec4 light(glm::dvec3(options_.ambient), 0.0);
        for (const SpotLight& spot : options_.lights) {
            const auto from = [&](const glm::dvec3& arriving) {
                return reflected(spot, options_.intensity, arriving, point, eye_);
            };
            if (from(spot.colour) != glm::dvec4(0.0)) light += from(past_shadows(rays, spot, point.place));
        }
        return lit_by(light, glm::dvec3(surface.colour)) + of.emission;
    }

    /// Of its colour, what arrives. The ray goes as the light looks, so that the same faces are culled as in its map.
    glm::dvec3 past_shadows(Rays& rays, const SpotLight& light, const glm::dvec3& point) const {
        if (options_.shadows == Shadows::none) return light.colour;
        const double distance = glm::distance(light.place, point);
        const WorldRay ray{light.place, point - light.place, light.lamp() / distance,
                           1.0 - rays.clearance() / distance};
        std::vector<RayHit> hits;
        rays.hits(ray, hits);
        glm::dvec3 passing(1.0);
        bool filtered = false;
        for (const RayHit& hit : hits) {
            const auto surface = rays.surface(hit);
            if (!surface) continue;
            if (options_.shadows == Shadows::opaque || is_opaque(*surface)) return glm::dvec3(0.0);
            if (!filtered || options_.filter == TruthFilter::product) passing *= share_through(*surface, light.colour);
            filtered = true;
        }
        return light.colour * passing;
    }

    glm::dvec3 share_through(const FrameSurface& pane, const glm::dvec3& light) const {
        const Filter<double> filter{0.0, glm::dvec4(glm::dvec3(pane.colour), static_cast<double>(opacity(pane)))};
        const glm::dvec3 through = light_through(filter, {}, 1.0, light);
        glm::dvec3 share(0.0);
        for (int i = 0; i < 3; ++i) share[i] = light[i] > 0.0 ? through[i] / light[i] : 0.0;
        return share;
    }

    /// What is seen aside of what lies right behind the pane, unless that lies in front of it (B8, 4 to 6).
    glm::dvec3 behind_pane(Rays& rays, const FrameSurface& pane, const PixelSurfaces& seen,
                           const glm::ivec2& at) const {
        const auto colour_of = [&](const PixelSurfaces& surfaces, const glm::ivec2& pixel) {
            return surfaces.has_opaque ? lit(rays, surfaces.opaque, pixel) : background_;
        };
        if (!options_.composition.refraction) return colour_of(seen, at);
        const double offset = options_.composition.coefficient * size_.y;
        const glm::ivec2 through = seen_through(at, to_eye_ * material_of(pane).normal, offset, size_);
        PixelSurfaces aside;
        rays.surfaces(static_cast<std::uint32_t>(through.x), static_cast<std::uint32_t>(through.y), aside);
        if (aside.has_opaque && aside.opaque.distance < pane.distance) return colour_of(seen, at);
        return colour_of(aside, through);
    }

    static bool beyond_critical(double cosine) {
        return 1.0 - cosine * cosine > 1.0 / (index_of_glass * index_of_glass);
    }

    bool reflects_totally(Rays& rays, const FrameSurface& pane, const glm::ivec2& at) const {
        const glm::dvec3 way =
            glm::normalize(rays.through(static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y)).step);
        const double facing = glm::dot(way, pane.normal);
        const bool outside = pane.front != draws_[pane.draw].mirrored;
        if (!outside) return beyond_critical(facing);
        const glm::dvec3 into = glm::refract(way, facing > 0.0 ? -pane.normal : pane.normal, 1.0 / index_of_glass);
        std::vector<RayHit> hits;
        rays.hits({place(rays, pane, at), into, rays.clearance()}, hits);
        const auto leaving =
            std::find_if(hits.begin(), hits.end(), [&](const RayHit& hit) { return hit.draw == pane.draw; });
        return leaving != hits.end() && beyond_critical(static_cast<double>(leaving->cosine));
    }

    DeferredTruth options_;
    SharedMaterials materials_;
    pipeline::SurfaceStore maps_;
    std::vector<pipeline::SurfaceId> slots_;
    std::vector<DeferredDraw> draws_;
    glm::dvec3 background_;
    glm::dmat3 to_eye_;
    glm::dvec3 eye_;
    glm::ivec2 size_;
};

} // namespace

TruthMethod deferred_truth(const Scene& scene, const pipeline::Frame& frame, DeferredTruth options) {
    pipeline::Frame drawn = frame_of(scene, frame.view);
    auto materials = std::make_shared<const MaterialReads>(
        drawn, CommonShine{static_cast<float>(options.specular), static_cast<float>(options.specular_power)},
        options.maps);
    const auto surfaces =
        std::make_shared<const pipeline::Frame>(frame_of_surfaces(std::move(drawn), frame, materials->any()));
    const auto traced = std::make_shared<const TracedPicture>(*surfaces, std::move(options), std::move(materials));
    TruthMethod method;
    method.frame = surfaces;
    method.channels = {
        {"opaque", "distance", false}, {"transparent", "distance", false}, {"total_reflection", "reflects", false}};
    method.hides = [traced](const FrameSurface& surface) { return traced->is_opaque(surface); };
    method.pixel = [traced](Rays& rays, const PixelSurfaces& seen, std::uint32_t x, std::uint32_t y,
                            TruthPicture& picture) { traced->make(rays, seen, glm::ivec2(x, y), picture); };
    method.rasterized = opaque_distances;
    return method;
}

} // namespace traces
