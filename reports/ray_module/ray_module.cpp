#include "reports/ray_module/ray_module.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <pmmintrin.h>
#include <xmmintrin.h>

struct RopsimRayScene {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    RopsimRayMask mask = nullptr;
    void* mask_data = nullptr;

    RopsimRayScene() = default;
    RopsimRayScene(const RopsimRayScene&) = delete;
    RopsimRayScene& operator=(const RopsimRayScene&) = delete;
    ~RopsimRayScene() {
        if (scene != nullptr) rtcReleaseScene(scene);
        if (device != nullptr) rtcReleaseDevice(device);
    }
};

namespace {

constexpr unsigned flush_denormals = _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON;

/// The floating-point mode of this thread, put back at the end.
class FloatMode {
  public:
    explicit FloatMode(unsigned mode) : before_(_mm_getcsr()) { _mm_setcsr(mode); }
    ~FloatMode() { _mm_setcsr(before_); }
    FloatMode(const FloatMode&) = delete;
    FloatMode& operator=(const FloatMode&) = delete;

    unsigned before() const { return before_; }

  private:
    unsigned before_;
};

/// What Embree wants.
class TracingMode : public FloatMode {
  public:
    TracingMode() : FloatMode(_mm_getcsr() | flush_denormals) {}
};

const char* text_of(RTCError error) {
    switch (error) {
    case RTC_ERROR_OUT_OF_MEMORY:
        return "out of memory";
    case RTC_ERROR_UNSUPPORTED_CPU:
        return "this processor is not supported";
    case RTC_ERROR_INVALID_ARGUMENT:
        return "invalid argument";
    case RTC_ERROR_INVALID_OPERATION:
        return "invalid operation";
    case RTC_ERROR_CANCELLED:
        return "cancelled";
    default:
        return "unknown error";
    }
}

void say(const char* message, char* error, std::size_t size) {
    if (size == 0) return;
    const std::size_t length = std::min(std::strlen(message), size - 1);
    std::memcpy(error, message, length);
    error[length] = '\0';
}

/// A context whose filter finds more behind it.
template <class Extra>
struct Context {
    RTCIntersectContext embree; // first: filters get a pointer to it
    Extra extra;

    explicit Context(const Extra& more) : extra(more) { rtcInitIntersectContext(&embree); }
    static const Extra& behind(const RTCFilterFunctionNArguments* arguments) {
        return reinterpret_cast<const Context*>(arguments->context)->extra;
    }
};

struct Collected {
    RopsimRayHit* hits;
    std::size_t capacity;
    std::size_t* count;
};

struct Asked {
    const RopsimRayScene* scene;
    unsigned float_mode; ///< of whoever asks
};

void collect(const RTCFilterFunctionNArguments* arguments) {
    const Collected& collected = Context<Collected>::behind(arguments);
    arguments->valid[0] = 0; // goes on as if nothing was hit
    const std::size_t at = (*collected.count)++;
    if (at >= collected.capacity) return;
    RTCHitN* hit = arguments->hit;
    collected.hits[at] = {RTCHitN_geomID(hit, 1, 0), RTCHitN_primID(hit, 1, 0), RTCRayN_tfar(arguments->ray, 1, 0),
                          RTCHitN_u(hit, 1, 0), RTCHitN_v(hit, 1, 0)};
}

void ask_mask(const RTCFilterFunctionNArguments* arguments) {
    const Asked& asked = Context<Asked>::behind(arguments);
    const FloatMode usual(asked.float_mode);
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] == 0) continue;
        RTCHitN* hit = arguments->hit;
        const unsigned n = arguments->N;
        if (asked.scene->mask(asked.scene->mask_data, RTCHitN_geomID(hit, n, i), RTCHitN_primID(hit, n, i),
                              RTCHitN_u(hit, n, i), RTCHitN_v(hit, n, i)) == 0)
            arguments->valid[i] = 0;
    }
}

void attach(const RopsimRayScene& owner, const RopsimRayMesh& mesh, unsigned number) {
    const RTCGeometry geometry = rtcNewGeometry(owner.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions, 0,
                               3 * sizeof(float), mesh.vertices);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices, 0,
                               3 * sizeof(std::uint32_t), mesh.triangles);
    if (mesh.masked != 0) rtcSetGeometryOccludedFilterFunction(geometry, ask_mask);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(owner.scene, geometry, number);
    rtcReleaseGeometry(geometry);
}

RopsimRayScene* create(const RopsimRayMesh* meshes, std::uint32_t count, RopsimRayMask mask, void* mask_data,
                       char* error, std::size_t size) {
    std::unique_ptr<RopsimRayScene> owner(new (std::nothrow) RopsimRayScene);
    if (owner == nullptr) return say(text_of(RTC_ERROR_OUT_OF_MEMORY), error, size), nullptr;
    const TracingMode mode;
    owner->device = rtcNewDevice(nullptr);
    if (owner->device == nullptr) return say(text_of(rtcGetDeviceError(nullptr)), error, size), nullptr;
    owner->mask = mask;
    owner->mask_data = mask_data;
    owner->scene = rtcNewScene(owner->device);
    rtcSetSceneFlags(owner->scene,
                     static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    for (std::uint32_t i = 0; i < count; ++i) attach(*owner, meshes[i], i);
    rtcCommitScene(owner->scene);
    const RTCError failed = rtcGetDeviceError(owner->device);
    if (failed != RTC_ERROR_NONE) return say(text_of(failed), error, size), nullptr;
    return owner.release();
}

void destroy(RopsimRayScene* scene) { delete scene; }

RTCRay ray_of(const RopsimRay& ray) {
    RTCRay result{};
    result.org_x = ray.origin[0];
    result.org_y = ray.origin[1];
    result.org_z = ray.origin[2];
    result.tnear = ray.begin;
    result.dir_x = ray.direction[0];
    result.dir_y = ray.direction[1];
    result.dir_z = ray.direction[2];
    result.tfar = ray.end;
    result.mask = ~0U;
    return result;
}

std::size_t hits(const RopsimRayScene* scene, const RopsimRay* ray, RopsimRayHit* found, std::size_t capacity) {
    const TracingMode mode;
    std::size_t count = 0;
    Context<Collected> context({found, capacity, &count});
    context.embree.filter = collect;
    RTCRayHit query{};
    query.ray = ray_of(*ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene->scene, &context.embree, &query);
    return count;
}

constexpr std::size_t packet = 8;

void occluded_packet(const RopsimRayScene* scene, RTCIntersectContext* context, const RopsimRay* rays,
                     std::size_t count, std::uint8_t* result) {
    RTCRay8 query{};
    alignas(32) int valid[packet];
    for (std::size_t i = 0; i < packet; ++i) {
        valid[i] = i < count ? -1 : 0;
        if (i >= count) continue;
        query.org_x[i] = rays[i].origin[0];
        query.org_y[i] = rays[i].origin[1];
        query.org_z[i] = rays[i].origin[2];
        query.tnear[i] = rays[i].begin;
        query.dir_x[i] = rays[i].direction[0];
        query.dir_y[i] = rays[i].direction[1];
        query.dir_z[i] = rays[i].direction[2];
        query.tfar[i] = rays[i].end;
        query.mask[i] = ~0U;
    }
    rtcOccluded8(valid, scene->scene, context, &query);
    for (std::size_t i = 0; i < count; ++i) result[i] = query.tfar[i] < 0.0F ? 1 : 0;
}

void occluded(const RopsimRayScene* scene, const RopsimRay* rays, std::size_t count, int coherent,
              std::uint8_t* result) {
    const TracingMode mode;
    Context<Asked> context({scene, mode.before()});
    if (coherent != 0) {
        context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        for (std::size_t i = 0; i < count; i += packet)
            occluded_packet(scene, &context.embree, rays + i, std::min(packet, count - i), result + i);
        return;
    }
    for (std::size_t i = 0; i < count; ++i) {
        RTCRay query = ray_of(rays[i]);
        rtcOccluded1(scene->scene, &context.embree, &query);
        result[i] = query.tfar < 0.0F ? 1 : 0; // Embree sets it to minus infinity
    }
}

constexpr RopsimRayModule ray_module{ROPSIM_RAY_MODULE_VERSION, create, destroy, hits, occluded};

} // namespace

extern "C" __attribute__((visibility("default"))) const RopsimRayModule* ropsim_ray_module() { return &ray_module; }
