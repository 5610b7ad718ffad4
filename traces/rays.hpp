// Ray-traced truth of a rendering method: what a workload declares so that its pictures can be judged.
//
// A workload gives a TruthMethod (workloads.hpp); whoever traces (reports/truth, with Embree) gives it Rays, calls it
// for every pixel and compares, keeps and shows what it makes. So only the workload knows how its picture comes from
// surfaces, and only the tracer knows how surfaces are found.
#pragma once

#include "pipeline/reference.hpp"
#include "traces/view_rays.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace traces {

/// The points origin + t * step with begin <= t <= end, in world space.
struct WorldRay {
    glm::dvec3 origin{0.0}, step{0.0};
    double begin = 0.0;
    double end = std::numeric_limits<double>::infinity();
};

/// Where a ray meets a triangle.
struct RayHit {
    double t = 0.0;         ///< as in WorldRay
    std::uint32_t mesh = 0; ///< number of the instance, over all draws in order
    std::uint32_t draw = 0; ///< index into the draws
    std::uint32_t triangle = 0;
    double u = 0.0, v = 0.0; ///< shares of the second and third corner; u, v and 1 - u - v lie in [0,1]
    float cosine = 0.0F;     ///< |cos| of the angle between ray and normal of the triangle
    bool front = false;      ///< the corners go round counter-clockwise, seen against the ray
};

/// A fragment of a frame, as the ray through its pixel's centre finds it.
struct FrameSurface {
    double distance = 0.0;  ///< along the view axis
    std::uint32_t draw = 0; ///< index into Frame::draws
    bool front = true;      ///< its triangle's corners go round counter-clockwise on the screen
    glm::vec4 colour{0.0F}; ///< as the material gives it: linear RGBA
    glm::dvec3 normal{0.0}; ///< likewise, in the world, of unit length or 0; 0 where no shader of the frame reads it
    /// As shaders that read maps of materials are given them (pipeline::ShaderInput), the tangent in the world: of the
    /// 2x2 block around the pixel, whose pixel `lane` this is, or four times the same where no block is.
    std::array<glm::vec4, 4> texcoords{};
    glm::vec4 tangent{0.0F};
    std::uint32_t lane = 0;
};

/// What one pixel sees.
struct PixelSurfaces {
    /// Of passes with a k-buffer, and of others what TruthMethod::hides sees through; in front of `opaque`, nearest
    /// first.
    std::vector<FrameSurface> layers;
    FrameSurface opaque; ///< nearest of what is left of the passes with a depth buffer
    bool has_opaque = false;
    /// The ray passes a layer's or the opaque surface's edge closely, or sees one edge-on: a rasterizer, which puts
    /// corners on a grid, may rightly see something else (specification 004, section 10.4).
    bool doubtful = false;
};

/// Rays into the scene of a frame. One object serves one thread.
class Rays {
  public:
    virtual ~Rays() = default;

    virtual const pipeline::Frame& frame() const = 0;
    /// Through the centres of the frame's pixels, in eye space.
    virtual const ViewRays& view_rays() const = 0;
    /// Through the centre of pixel (x, y), from the near to the far plane.
    virtual WorldRay through(std::uint32_t x, std::uint32_t y) const = 0;
    /// Where a surface of that pixel lies in the world, by its distance along the view axis.
    virtual glm::dvec3 place(std::uint32_t x, std::uint32_t y, double distance) const = 0;

    /// All hits of any ray, nearest first; neither faces nor alpha are looked at. `hits` is overwritten.
    virtual void hits(const WorldRay& ray, std::vector<RayHit>& hits) = 0;
    /// occluded[i] becomes 1 if ray i meets anything that its alpha test leaves standing, else 0; what lies at either
    /// end does not count. `coherent`: neighbours in the list go nearly the same way.
    virtual void occluded(std::span<const WorldRay> rays, bool coherent, std::span<std::uint8_t> occluded) = 0;
    /// Hits that lie nearer than this to an end of a ray may be the surface there.
    virtual double clearance() const = 0;
    /// What a view along the ray would see at a hit, with textures in their finest level; nothing where it faces away
    /// or is discarded. The distance is t of the hit.
    virtual std::optional<FrameSurface> surface(const RayHit& hit) const = 0;
    /// What another pixel sees, as TruthMethod::pixel gets it of its own. `seen` is overwritten.
    virtual void surfaces(std::uint32_t x, std::uint32_t y, PixelSurfaces& seen) = 0;
};

/// The points centre + a * u + b * v with a and b in [-1,1], in world space; u and v are orthogonal.
struct SquareLight {
    glm::dvec3 centre{0.0};
    glm::dvec3 u{0.0}, v{0.0}; ///< half edges
};

/// A number for each pixel, beside its colour.
struct TruthChannel {
    std::string name;                     ///< of its file
    std::string quantity;                 ///< what the number is
    bool everywhere = true;               ///< else only at the pixels where it was set
    std::vector<float> values = {};       ///< by pixel; 0 where nothing was set
    std::vector<std::uint8_t> known = {}; ///< by pixel, unless everywhere

    void set(std::size_t pixel, double value) {
        values[pixel] = static_cast<float>(value);
        if (!everywhere) known[pixel] = 1;
    }
    bool has(std::size_t pixel) const { return everywhere || known[pixel] != 0; }
};

/// Row 0 first. Different pixels may be written by different threads.
struct TruthPicture {
    std::uint32_t width = 0, height = 0; ///< pixels
    std::vector<float> colours;          ///< linear RGBA
    std::vector<TruthChannel> channels;  ///< as the method declares them

    std::size_t pixels() const { return std::size_t{width} * height; }
    std::size_t pixel(std::uint32_t x, std::uint32_t y) const { return std::size_t{y} * width + x; }
    void set_colour(std::size_t pixel, const glm::dvec3& colour);
};

struct TruthMethod {
    /// Whose passes say which surfaces there are, where not those of the workload's own frame.
    std::shared_ptr<const pipeline::Frame> frame = {};
    std::vector<TruthChannel> channels = {}; ///< names and quantities
    /// Whether a fragment of a pass with a depth buffer hides what lies behind it; empty: all do.
    std::function<bool(const FrameSurface&)> hides = {};
    /// Makes colour and channels of pixel (x, y) from what it sees. Called for pixels in any order, by many threads.
    std::function<void(Rays&, const PixelSurfaces&, std::uint32_t x, std::uint32_t y, TruthPicture&)> pixel = {};
    std::function<void(const pipeline::Frame&, TruthPicture&)> finish = {}; ///< after the last pixel; may be empty
    /// What the rasterized surfaces of its frame have for the first channel, by pixel: distances that are compared in
    /// place of the colours, where these are no fair comparison. May be empty.
    std::function<std::vector<std::optional<double>>(const pipeline::Frame&, const pipeline::ReferenceImage&)>
        rasterized = {};
    std::optional<SquareLight> light = {}; ///< how much of it each pixel's surface sees is part of the truth
    /// What the truth follows from, beside scene, view and what is asked of the rays; nothing: all parameters of the
    /// workload.
    std::optional<std::string> key = {};
};

/// Layers, all of this opacity, composited front to back over the opaque surface or the background (specification 004,
/// A11).
TruthMethod layered_truth(float opacity = 1.0F);

} // namespace traces
