// Rays per second of the ray-tracing module, beside Embree called directly with the same rays; one thread.
#ifdef ROPSIM_HAVE_EMBREE

#include "reports/truth/light_visibility.hpp"
#include "reports/truth/truth.hpp"
#include "sim/random.hpp"
#include "traces/camera.hpp"
#include "traces/scene.hpp"
#include "traces/workloads.hpp"

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

namespace {

constexpr std::size_t rays_per_batch = 1 << 16;

struct Setting {
    traces::Scene scene = traces::load_scene("gen:blob?triangles=200000");
    reports::RayScene rays{scene.resources, scene.draws};

    /// From points round the blob to others, so that about half of them meet it.
    std::vector<reports::WorldRay> incoherent() const {
        sim::Random random(1, "rays");
        const auto place = [&] {
            return glm::dvec3(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5) * 2.5 *
                       static_cast<double>(scene.radius) +
                   0.5 * glm::dvec3(scene.lo + scene.hi);
        };
        std::vector<reports::WorldRay> list(rays_per_batch);
        for (reports::WorldRay& ray : list) {
            ray.origin = place();
            ray.step = place() - ray.origin;
            ray.end = 1.0;
        }
        return list;
    }
};

const Setting& setting() {
    static const Setting only;
    return only;
}

void count_rays(benchmark::State& state, std::size_t rays) {
    state.counters["rays/s"] = benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(rays),
                                                  benchmark::Counter::kIsRate);
}

void incoherent_occlusion_module(benchmark::State& state) {
    const auto rays = setting().incoherent();
    std::vector<std::uint8_t> occluded(rays.size());
    for (auto _ : state) setting().rays.occluded(rays, false, occluded);
    count_rays(state, rays.size());
}
BENCHMARK(incoherent_occlusion_module)->Unit(benchmark::kMillisecond);

/// The same triangles in a robust scene of its own.
class Direct {
  public:
    explicit Direct(const reports::RayScene& scene) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        const auto triangles = static_cast<std::uint32_t>(scene.triangles());
        auto* position = static_cast<float*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, std::size_t{triangles} * 3));
        auto* index = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles));
        for (std::uint32_t triangle = 0; triangle < triangles; ++triangle)
            for (const glm::dvec3& corner : scene.corners(0, triangle)) {
                for (int axis = 0; axis < 3; ++axis) *position++ = static_cast<float>(corner[axis]);
                *index = static_cast<std::uint32_t>(index - first_index(geometry));
                ++index;
            }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(scene_);
    }
    ~Direct() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    Direct(const Direct&) = delete;
    Direct& operator=(const Direct&) = delete;

    RTCScene scene() const { return scene_; }

  private:
    static std::uint32_t* first_index(RTCGeometry geometry) {
        return static_cast<std::uint32_t*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_INDEX, 0));
    }

    RTCDevice device_;
    RTCScene scene_;
};

RTCRay direct_ray(const reports::WorldRay& ray) {
    RTCRay result{};
    result.org_x = static_cast<float>(ray.origin.x);
    result.org_y = static_cast<float>(ray.origin.y);
    result.org_z = static_cast<float>(ray.origin.z);
    result.dir_x = static_cast<float>(ray.step.x);
    result.dir_y = static_cast<float>(ray.step.y);
    result.dir_z = static_cast<float>(ray.step.z);
    result.tfar = static_cast<float>(ray.end);
    result.mask = ~0U;
    return result;
}

void incoherent_occlusion_embree(benchmark::State& state) {
    const Direct direct(setting().rays);
    std::vector<RTCRay> rays;
    for (const reports::WorldRay& ray : setting().incoherent()) rays.push_back(direct_ray(ray));
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    std::size_t hidden = 0;
    for (auto _ : state)
        for (const RTCRay& ray : rays) {
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            RTCRay query = ray;
            rtcOccluded1(direct.scene(), &context, &query);
            hidden += query.tfar < 0.0F ? 1 : 0;
        }
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_OFF);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_OFF);
    benchmark::DoNotOptimize(hidden);
    count_rays(state, rays.size());
}
BENCHMARK(incoherent_occlusion_embree)->Unit(benchmark::kMillisecond);

/// A light over a blob of 100,000 triangles, 1024 rays from every 16th pixel of 800x600; Arg: threads.
void area_light(benchmark::State& state) {
    const traces::Scene scene = traces::load_scene("gen:blob?triangles=100000");
    const reports::RayScene rays(scene.resources, scene.draws);
    const auto first = reports::first_hits(rays, traces::make_view(scene, "auto", 800, 600));
    std::vector<glm::dvec3> points;
    for (std::size_t pixel = 0; pixel < first.size(); pixel += 16)
        if (first[pixel].seen()) points.push_back(first[pixel].position);
    const double r = static_cast<double>(scene.radius);
    const reports::SquareLight light{0.5 * glm::dvec3(scene.lo + scene.hi) + glm::dvec3(0.0, 3.0 * r, 0.0),
                                     {0.5 * r, 0.0, 0.0},
                                     {0.0, 0.0, 0.5 * r}};
    for (auto _ : state)
        reports::light_visibility(rays, points, light, {.rays = 1000},
                                  {.threads = static_cast<unsigned>(state.range(0))});
    count_rays(state, points.size() * 1024);
}
BENCHMARK(area_light)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void truth_of_transparency(benchmark::State& state) {
    const pipeline::Frame frame =
        traces::build_frame(setting().scene, traces::make_view(setting().scene, "auto", 512, 512), "transparency");
    const traces::TruthMethod method = traces::truth_method(setting().scene, frame, "transparency");
    std::uint64_t hits = 0;
    for (auto _ : state) hits = reports::trace_truth(frame, setting().rays, method, {}, {.threads = 1}).counts.surfaces;
    count_rays(state, 512 * 512);
    state.counters["hits"] = benchmark::Counter(static_cast<double>(hits));
}
BENCHMARK(truth_of_transparency)->Unit(benchmark::kMillisecond);

} // namespace

#endif
