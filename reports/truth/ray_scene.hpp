// Drawn triangles as rays see them: all hits along a ray, and whether anything lies between two points.
//
// Embree (ropsim_rays.so, loaded by the first RayScene) finds which triangles a ray meets; where it meets them is then
// computed in binary64 from the triangle itself. The whole scene is moved and scaled into a unit ball first, so that no
// tolerance below depends on where it lies or how large it is.
//
// Modelled: every instance of every draw, each a geometry of its own, from both sides; alpha tests where asked for.
// Not modelled: instancing (a scene that repeats a geometry a thousand times holds it a thousand times), motion.
// Source: specification 004, section 10.4.
#pragma once

#include "pipeline/draw.hpp"
#include "traces/rays.hpp"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

namespace reports {

class AlphaMasks;

using traces::RayHit;
using traces::WorldRay;

/// Throws sim::InputError when rays cannot be traced here.
void require_rays();

class RayScene {
  public:
    /// Throws sim::InputError when Embree cannot be had or has no memory.
    RayScene(std::shared_ptr<const pipeline::Resources> resources, std::vector<pipeline::Draw> draws);
    ~RayScene();
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;

    /// All hits, nearest first, those at one place in order of submission; alpha is not tested. Triangles that meet in
    /// an edge or corner through which the ray goes count once if they face alike: the ray crosses one surface there.
    /// `hits` is overwritten.
    void hits(const WorldRay& ray, std::vector<RayHit>& hits) const;

    /// occluded[i] becomes 1 if ray i meets anything that its alpha test leaves standing (textures in their finest
    /// level), else 0. What lies within clearance() of either end does not count. `coherent`: neighbours in the list go
    /// nearly the same way.
    void occluded(std::span<const WorldRay> rays, bool coherent, std::span<std::uint8_t> occluded) const;

    /// Far more than the error of a hit, far less than anything one would see: 2^-16 of the scene's radius.
    double clearance() const { return 0x1p-16 * radius_; }

    const pipeline::Resources& resources() const { return *resources_; }
    const std::vector<pipeline::Draw>& draws() const { return draws_; }
    std::uint64_t triangles() const; ///< of all instances

    /// The alpha test of the hit's material, its texture read in the finest level.
    bool stands(const RayHit& hit) const;
    /// Of the triangle that was hit, of unit length, to the side from which its corners go round counter-clockwise; 0
    /// where it has no area.
    glm::dvec3 normal(const RayHit& hit) const;
    /// Corners of a triangle in world space, as they were rounded for the tracing.
    std::array<glm::dvec3, 3> corners(std::uint32_t mesh, std::uint32_t triangle) const;
    /// The model matrix of a mesh, and its three vertices in the geometry.
    const glm::mat4& model(std::uint32_t mesh) const;
    std::array<std::uint32_t, 3> vertices(std::uint32_t mesh, std::uint32_t triangle) const;

  private:
    struct Mesh;
    class Embree;

    void make_meshes();
    void fill(Mesh& mesh) const;
    std::array<glm::dvec3, 3> scaled_corners(const Mesh& mesh, std::uint32_t triangle) const;
    void refine(const glm::dvec3& origin, const glm::dvec3& direction, RayHit& hit) const;
    struct ScaledRay;
    ScaledRay scaled(const WorldRay& ray) const;
    void drop_doubles(const glm::dvec3& origin, std::vector<RayHit>& hits) const;
    bool one_crossing(const glm::dvec3& origin, const RayHit& a, const RayHit& b) const;

    std::shared_ptr<const pipeline::Resources> resources_;
    std::vector<pipeline::Draw> draws_;
    glm::dvec3 centre_{0.0}; ///< of the bounding box
    double radius_ = 1.0;    ///< half its diagonal, up to a power of two: scaling is exact
    std::vector<Mesh> meshes_;
    std::unique_ptr<const AlphaMasks> masks_;
    std::unique_ptr<Embree> embree_;
};

} // namespace reports
