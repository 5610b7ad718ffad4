#include "reports/truth/light_visibility.hpp"

#include <algorithm>
#include <cmath>

namespace reports {

namespace {

constexpr std::size_t points_per_piece = 64;

/// A well-mixed function of its argument (the finaliser of SplitMix64: Steele, Lea, Flood 2014).
constexpr std::uint64_t mixed(std::uint64_t bits) {
    bits = (bits ^ (bits >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    bits = (bits ^ (bits >> 27U)) * 0x94D049BB133111EBULL;
    return bits ^ (bits >> 31U);
}

/// Two numbers in [0,1) for one part of the light at one point.
struct Jitter {
    double a, b;

    Jitter(std::uint64_t stream, std::uint64_t part) {
        constexpr std::uint64_t golden = 0x9E3779B97F4A7C15ULL;
        const std::uint64_t bits = mixed(stream + golden * (part + 1));
        a = static_cast<double>(bits >> 32U) * 0x1p-32;
        b = static_cast<double>(bits & 0xFFFFFFFFU) * 0x1p-32;
    }
};

class LightRays {
  public:
    LightRays(const SquareLight& light, const LightSampling& sampling)
        : light_(light), seed_(mixed(sampling.seed)), parts_(light_parts(sampling.rays)) {}

    std::size_t count() const { return std::size_t{parts_} * parts_; }

    /// The rays from a point, t from 0 at the point to 1 on the light.
    void make(const glm::dvec3& point, std::uint64_t number, std::vector<WorldRay>& rays) const {
        const std::uint64_t stream = mixed(seed_ ^ mixed(number));
        rays.clear();
        for (std::uint32_t row = 0; row < parts_; ++row)
            for (std::uint32_t column = 0; column < parts_; ++column) {
                const Jitter jitter(stream, rays.size());
                const double a = 2.0 * (column + jitter.a) / parts_ - 1.0, b = 2.0 * (row + jitter.b) / parts_ - 1.0;
                rays.push_back({point, light_.centre + a * light_.u + b * light_.v - point, 0.0, 1.0});
            }
    }

  private:
    SquareLight light_;
    std::uint64_t seed_;
    std::uint32_t parts_;
};

} // namespace

std::uint32_t light_parts(std::uint32_t rays) {
    return std::max(1U, static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(rays)))));
}

std::vector<float> light_visibility(const RayScene& scene, std::span<const glm::dvec3> points, const SquareLight& light,
                                    const LightSampling& sampling, const TracingOptions& options) {
    const LightRays light_rays(light, sampling);
    std::vector<float> visibility(points.size());
    trace_pieces(options, (points.size() + points_per_piece - 1) / points_per_piece, [&](std::size_t piece) {
        std::vector<WorldRay> rays;
        std::vector<std::uint8_t> occluded(light_rays.count());
        const std::size_t begin = piece * points_per_piece, end = std::min(begin + points_per_piece, points.size());
        for (std::size_t i = begin; i < end; ++i) {
            light_rays.make(points[i], sampling.first_point + i, rays);
            scene.occluded(rays, true, occluded);
            const auto hidden = static_cast<double>(std::count(occluded.begin(), occluded.end(), 1));
            visibility[i] = static_cast<float>(1.0 - hidden / static_cast<double>(rays.size()));
        }
    });
    return visibility;
}

} // namespace reports
