#include "reports/truth/ray_scene.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "reports/ray_module/ray_module.h"
#include "reports/truth/alpha_masks.hpp"
#include "reports/truth/plane_weights.hpp"
#include "ropsim_build.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <dlfcn.h>
#include <fmt/format.h>
#include <tuple>

namespace reports {

namespace {

[[noreturn]] void no_rays(const std::string& reason) {
    throw sim::InputError(
        fmt::format("ray tracing needs ropsim_rays.so and Embree (Debian: libembree3-3): {}", reason));
}

const RopsimRayModule* load_module() {
    const auto path = ropsim_build::find_module("ropsim_rays.so");
    if (!path) no_rays("ropsim_rays.so was not found");
    void* library = ::dlopen(path->c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) no_rays(::dlerror());
    const auto function = reinterpret_cast<RopsimRayModuleFunction>(::dlsym(library, ROPSIM_RAY_MODULE_FUNCTION));
    const RopsimRayModule* rays = function == nullptr ? nullptr : function();
    if (rays == nullptr || rays->version != ROPSIM_RAY_MODULE_VERSION)
        no_rays(path->string() + " is of another version of ropsim");
    return rays;
}

const RopsimRayModule& ray_module() {
    static const RopsimRayModule* const loaded = load_module(); // stays loaded; a failure is tried again
    return *loaded;
}

struct Box {
    glm::dvec3 lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};
    void add(const glm::dvec3& point) {
        lo = glm::min(lo, point);
        hi = glm::max(hi, point);
    }
};

/// Calls take(vertex, its place in world space) for all vertices of a geometry that are used.
template <class Take>
void for_each_place(const pipeline::Resources& resources, const pipeline::Geometry& geometry, const glm::mat4& model,
                    Take take) {
    const pipeline::VertexRange used = pipeline::used_vertices(resources, geometry);
    const pipeline::AttributeReader position(resources, *geometry.find(pipeline::Semantic::position));
    const glm::dmat4 matrix(model);
    for (std::uint32_t vertex = used.first; vertex < used.end; ++vertex)
        take(vertex - used.first, glm::dvec3(matrix * glm::dvec4(glm::dvec3(glm::vec3(position(vertex))), 1.0)));
}

float bounded(double value) {
    constexpr double largest = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(value, -largest, largest));
}

RopsimRay module_ray(const glm::dvec3& origin, const glm::dvec3& direction, double begin, double end) {
    const glm::vec3 o(origin), d(direction);
    return {{o.x, o.y, o.z}, bounded(begin), {d.x, d.y, d.z}, bounded(end)};
}

} // namespace

void require_rays() { ray_module(); }

struct RayScene::Mesh {
    std::uint32_t draw = 0, instance = 0;
    std::uint32_t first_vertex = 0; ///< of the geometry
    std::vector<float> positions;   ///< in the unit ball, and one more float that Embree may read
    std::vector<std::uint32_t> indices;

    std::uint32_t triangles() const { return static_cast<std::uint32_t>(indices.size() / 3); }
    glm::dvec3 position(std::uint32_t vertex) const {
        const float* p = positions.data() + std::size_t{vertex} * 3;
        return {p[0], p[1], p[2]};
    }
};

/// A ray as the unit ball sees it. One that comes from afar begins just before the ball: neither Embree's range nor its
/// precision would do for the whole way.
struct RayScene::ScaledRay {
    glm::dvec3 origin{0.0}, direction{0.0}; ///< of unit length
    double stretch = 0.0;                   ///< scaled length of a step
    double skipped = 0.0, length = -1.0;    ///< before it begins, and from there on; below 0: it meets nothing

    bool passes() const { return length >= 0.0; }
};

/// The scene on the other side of the C interface.
class RayScene::Embree {
  public:
    Embree(const std::vector<Mesh>& meshes, const AlphaMasks& masks) : masks_(masks), module_(ray_module()) {
        std::vector<RopsimRayMesh> list;
        list.reserve(meshes.size());
        for (const Mesh& mesh : meshes)
            list.push_back({mesh.positions.data(), static_cast<std::uint32_t>(mesh.positions.size() / 3),
                            mesh.indices.data(), mesh.triangles(), masks.masked(list.size()) ? 1 : 0});
        std::array<char, 200> error{};
        scene_ =
            module_.create(list.data(), static_cast<std::uint32_t>(list.size()), ask, this, error.data(), error.size());
        if (scene_ == nullptr) no_rays(error.data());
    }
    ~Embree() { module_.destroy(scene_); }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    /// Until all of them have room; there are usually few.
    void hits(const RopsimRay& ray, std::vector<RopsimRayHit>& found) const {
        found.resize(std::max<std::size_t>(found.capacity(), 32));
        std::size_t count = module_.hits(scene_, &ray, found.data(), found.size());
        if (count > found.size()) {
            found.resize(count);
            count = module_.hits(scene_, &ray, found.data(), found.size());
        }
        found.resize(count);
    }

    void occluded(const std::vector<RopsimRay>& rays, bool coherent, std::span<std::uint8_t> result) const {
        module_.occluded(scene_, rays.data(), rays.size(), coherent ? 1 : 0, result.data());
    }

  private:
    static int ask(void* self, std::uint32_t mesh, std::uint32_t triangle, float u, float v) {
        return static_cast<const Embree*>(self)->masks_.stands(mesh, triangle, u, v) ? 1 : 0;
    }

    const AlphaMasks& masks_;
    const RopsimRayModule& module_;
    RopsimRayScene* scene_ = nullptr;
};

RayScene::RayScene(std::shared_ptr<const pipeline::Resources> resources, std::vector<pipeline::Draw> draws)
    : resources_(std::move(resources)), draws_(std::move(draws)) {
    require_rays();
    make_meshes();
    masks_ = std::make_unique<const AlphaMasks>(*resources_, draws_);
    embree_ = std::make_unique<Embree>(meshes_, *masks_);
}

RayScene::~RayScene() = default;

void RayScene::make_meshes() {
    Box box;
    for (std::uint32_t draw = 0; draw < draws_.size(); ++draw)
        for (std::uint32_t instance = 0; instance < draws_[draw].instances.size(); ++instance) {
            Mesh mesh;
            mesh.draw = draw;
            mesh.instance = instance;
            for_each_place(*resources_, resources_->geometries[draws_[draw].geometry], draws_[draw].instances[instance],
                           [&](std::uint32_t, const glm::dvec3& place) { box.add(place); });
            meshes_.push_back(std::move(mesh));
        }
    const double diagonal = glm::length(box.hi - box.lo);
    if (std::isfinite(diagonal)) centre_ = 0.5 * (box.lo + box.hi);
    if (std::isfinite(diagonal) && diagonal > 0.0) radius_ = std::exp2(std::ceil(std::log2(0.5 * diagonal)));
    for (Mesh& mesh : meshes_) fill(mesh);
}

void RayScene::fill(Mesh& mesh) const {
    const pipeline::Draw& draw = draws_[mesh.draw];
    const pipeline::Geometry& geometry = resources_->geometries[draw.geometry];
    const pipeline::VertexRange used = pipeline::used_vertices(*resources_, geometry);
    mesh.first_vertex = used.first;
    mesh.positions.resize(std::size_t{used.end - used.first} * 3 + 1);
    for_each_place(
        *resources_, geometry, draw.instances[mesh.instance], [&](std::uint32_t vertex, const glm::dvec3& place) {
            const glm::dvec3 scaled = (place - centre_) / radius_;
            for (int axis = 0; axis < 3; ++axis)
                mesh.positions[std::size_t{vertex} * 3 + static_cast<std::size_t>(axis)] = bounded(scaled[axis]);
        });
    const pipeline::PrimitiveReader read(*resources_, geometry);
    const std::uint32_t triangles = geometry.triangle_count();
    mesh.indices.reserve(std::size_t{triangles} * 3);
    for (std::uint32_t triangle = 0; triangle < triangles; ++triangle)
        for (const std::uint32_t vertex : read(triangle)) mesh.indices.push_back(vertex - used.first);
}

std::uint64_t RayScene::triangles() const {
    std::uint64_t sum = 0;
    for (const Mesh& mesh : meshes_) sum += mesh.triangles();
    return sum;
}

std::array<glm::dvec3, 3> RayScene::scaled_corners(const Mesh& mesh, std::uint32_t triangle) const {
    const std::uint32_t* index = mesh.indices.data() + std::size_t{triangle} * 3;
    return {mesh.position(index[0]), mesh.position(index[1]), mesh.position(index[2])};
}

std::array<glm::dvec3, 3> RayScene::corners(std::uint32_t mesh, std::uint32_t triangle) const {
    std::array<glm::dvec3, 3> corners = scaled_corners(meshes_[mesh], triangle);
    for (glm::dvec3& corner : corners) corner = centre_ + radius_ * corner;
    return corners;
}

bool RayScene::stands(const RayHit& hit) const {
    return !masks_->masked(hit.mesh) ||
           masks_->stands(hit.mesh, hit.triangle, static_cast<float>(hit.u), static_cast<float>(hit.v));
}

glm::dvec3 RayScene::normal(const RayHit& hit) const {
    const auto corners = scaled_corners(meshes_[hit.mesh], hit.triangle);
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double length = glm::length(normal);
    return length > 0.0 ? normal / length : glm::dvec3(0.0);
}

const glm::mat4& RayScene::model(std::uint32_t mesh) const {
    return draws_[meshes_[mesh].draw].instances[meshes_[mesh].instance];
}

std::array<std::uint32_t, 3> RayScene::vertices(std::uint32_t mesh, std::uint32_t triangle) const {
    const std::uint32_t* index = meshes_[mesh].indices.data() + std::size_t{triangle} * 3;
    const std::uint32_t first = meshes_[mesh].first_vertex;
    return {first + index[0], first + index[1], first + index[2]};
}

RayScene::ScaledRay RayScene::scaled(const WorldRay& ray) const {
    constexpr double near = 4.0, ahead = 2.0; // radii
    ScaledRay result;
    result.stretch = glm::length(ray.step) / radius_;
    result.direction = glm::normalize(ray.step);
    result.origin = (ray.origin + ray.begin * ray.step - centre_) / radius_;
    const double length = (ray.end - ray.begin) * result.stretch;
    if (!(length >= 0.0) || !(result.stretch > 0.0) || !std::isfinite(result.stretch)) return result;
    if (!(glm::length(result.origin) <= near)) {
        const double closest = -glm::dot(result.origin, result.direction);
        if (!(glm::length(result.origin + closest * result.direction) < ahead)) return result;
        result.skipped = std::max(0.0, closest - ahead);
        result.origin += result.skipped * result.direction;
    }
    result.length = length - result.skipped;
    return result;
}

void RayScene::hits(const WorldRay& ray, std::vector<RayHit>& hits) const {
    thread_local std::vector<RopsimRayHit> found;
    hits.clear();
    const ScaledRay here = scaled(ray);
    if (!here.passes()) return;
    embree_->hits(module_ray(here.origin, here.direction, 0.0, here.length), found);
    for (const RopsimRayHit& one : found) {
        RayHit hit;
        hit.t = static_cast<double>(one.distance);
        hit.mesh = one.mesh;
        hit.draw = meshes_[one.mesh].draw;
        hit.triangle = one.triangle;
        hit.u = static_cast<double>(one.u);
        hit.v = static_cast<double>(one.v);
        refine(here.origin, here.direction, hit);
        hits.push_back(hit);
    }
    const auto place = [](const RayHit& hit) { return std::tuple(hit.t, hit.mesh, hit.triangle); };
    std::sort(hits.begin(), hits.end(), [&](const RayHit& a, const RayHit& b) { return place(a) < place(b); });
    drop_doubles(here.origin, hits);
    for (RayHit& hit : hits) hit.t = ray.begin + (here.skipped + hit.t) / here.stretch;
}

// Embree computes in binary32. Where the triangle is seen so nearly edge-on that the plane says something else
// altogether, Embree's word stands.
void RayScene::refine(const glm::dvec3& origin, const glm::dvec3& direction, RayHit& hit) const {
    const auto corners = scaled_corners(meshes_[hit.mesh], hit.triangle);
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double along = glm::dot(normal, direction), length = glm::length(normal);
    hit.cosine = length > 0.0 ? static_cast<float>(std::min(1.0, std::fabs(along) / length)) : 0.0F;
    hit.front = along < 0.0;
    const auto exact = meet_plane(corners, origin, direction);
    constexpr double trusted = 1e-4;
    if (exact && std::fabs(exact->t - hit.t) <= trusted * (1.0 + std::fabs(hit.t))) {
        hit.t = exact->t;
        hit.u = exact->u;
        hit.v = exact->v;
    }
    hit.u = std::clamp(hit.u, 0.0, 1.0);
    hit.v = std::clamp(hit.v, 0.0, 1.0 - hit.u);
}

void RayScene::drop_doubles(const glm::dvec3& origin, std::vector<RayHit>& hits) const {
    constexpr double window = 1e-4; // in which the hits of neighbours at their common edge lie
    std::size_t kept = 0;
    for (const RayHit& hit : hits) {
        bool is_double = false;
        for (std::size_t i = kept; i-- > 0 && hit.t - hits[i].t <= window * (1.0 + hit.t) && !is_double;)
            is_double = one_crossing(origin, hits[i], hit);
        if (!is_double) hits[kept++] = hit;
    }
    hits.resize(kept);
}

// The same triangle twice, or two of one mesh that face alike, share a corner by place, and are both met at their rim.
bool RayScene::one_crossing(const glm::dvec3& origin, const RayHit& a, const RayHit& b) const {
    if (a.mesh != b.mesh) return false;
    if (a.triangle == b.triangle) return true;
    if (a.front != b.front) return false;
    const auto first = scaled_corners(meshes_[a.mesh], a.triangle),
               second = scaled_corners(meshes_[b.mesh], b.triangle);
    // What the coordinates of a hit are uncertain by, in units of the scene's radius.
    const double uncertainty = 4e-7 * (1.0 + glm::length(origin));
    if (distance_to_rim(first, a.u, a.v) > uncertainty || distance_to_rim(second, b.u, b.v) > uncertainty) return false;
    return std::any_of(first.begin(), first.end(), [&](const glm::dvec3& corner) {
        return std::find(second.begin(), second.end(), corner) != second.end();
    });
}

void RayScene::occluded(std::span<const WorldRay> rays, bool coherent, std::span<std::uint8_t> occluded) const {
    CHECK(rays.size() == occluded.size());
    thread_local std::vector<RopsimRay> passing;
    thread_local std::vector<std::uint8_t> met;
    const double clear = clearance() / radius_;
    passing.clear();
    // Until it is known, occluded[i] says that ray i passes the scene.
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const ScaledRay ray = scaled(rays[i]);
        const double begin = std::max(0.0, clear - ray.skipped), end = ray.length - clear;
        occluded[i] = begin < end ? 1 : 0;
        if (begin < end) passing.push_back(module_ray(ray.origin, ray.direction, begin, end));
    }
    met.resize(passing.size());
    embree_->occluded(passing, coherent, met);
    auto next = met.begin();
    for (std::uint8_t& result : occluded)
        if (result != 0) result = *next++;
}

} // namespace reports
