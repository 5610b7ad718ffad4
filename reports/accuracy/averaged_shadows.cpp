#include "reports/accuracy/averaged_shadows.hpp"

#include "sim/check.hpp"

#include <fmt/format.h>

namespace reports {

namespace {

// Of the square [-1,1]^2: the middles of 2^i x 2^i parts, in an order in which every 4^i of them are evenly spread.
glm::dvec2 place_on_light(std::uint32_t number, std::uint32_t lights) {
    std::uint32_t x = 0, y = 0, parts = 1;
    for (std::uint32_t left = lights; left > 1; left /= 4, parts *= 2) {
        x = x * 2 + number % 2;
        y = y * 2 + number / 2 % 2;
        number /= 4;
    }
    const auto middle = [parts](std::uint32_t at) { return (2.0 * at + 1.0) / parts - 1.0; };
    return {middle(x), middle(y)};
}

std::string light_text(const pipeline::SquareLight& light, const glm::dvec2& place, const glm::dvec3& forward) {
    const glm::dvec3 at = light.centre + place.x * light.u + place.y * light.v, target = at + forward;
    return fmt::format("light={},{},{},{},{},{}", at.x, at.y, at.z, target.x, target.y, target.z);
}

double eye_cycles(const pipeline::RunResult& run) {
    double cycles = 0;
    for (const pipeline::PassResult& pass : run.passes)
        if (pass.name == "eye" || pass.name == "clear") cycles += static_cast<double>(pass.cycles);
    return cycles;
}

// Settings that only the layered method knows are of no use here.
std::vector<std::string> hard_settings(const std::vector<std::string>& settings) {
    std::vector<std::string> kept;
    for (const std::string& setting : settings)
        for (const char* shared : {"map_size=", "format=", "bias=", "uniform_bias=", "gscale=", "gmax="})
            if (setting.starts_with(shared)) kept.push_back(setting);
    for (const char* own : {"method=hard", "light_size=0", "layers=1", "k=2"}) kept.emplace_back(own);
    return kept;
}

AveragedShadows average(const ComparisonRequest& base, const pipeline::SquareLight& light, const glm::dvec3& forward,
                        std::uint32_t lights, const Supervision& supervision) {
    AveragedShadows result;
    result.lights = lights;
    std::vector<double> visible;
    for (std::uint32_t i = 0; i < lights; ++i) {
        ComparisonRequest one = base;
        one.workload_settings.push_back(light_text(light, place_on_light(i, lights), forward));
        Comparison comparison = compare(prepare(one, supervision), supervision);
        const pipeline::RunResult& run = comparison.runs.front();
        const double cycles = static_cast<double>(run.cycles) - (i == 0 ? 0.0 : eye_cycles(run));
        result.sim_ms += cycles / (run.core_mhz * 1000.0);
        result.host_s += run.host_seconds + comparison.host.front_end_seconds;
        FramePixels& pixels = comparison.pixels.front();
        visible.resize(pixels.composite.size() / 4);
        for (std::size_t pixel = 0; pixel < visible.size(); ++pixel)
            visible[pixel] += static_cast<double>(pixels.composite[4 * pixel + 3]) / lights;
        if (i + 1 < lights) continue;
        result.pixels = std::move(pixels);
        result.frame = comparison.frame;
    }
    for (std::size_t pixel = 0; pixel < visible.size(); ++pixel)
        result.pixels.composite[4 * pixel + 3] = static_cast<float>(visible[pixel]);
    return result;
}

} // namespace

std::vector<AveragedShadows> average_hard_shadows(const AccuracyRequest& request, const Supervision& supervision) {
    ComparisonRequest base = request.comparison;
    const ComparisonInput area = prepare(base, supervision);
    if (!area.frame->light || !area.frame->kbuffer_view)
        throw sim::InputError(fmt::format("--averaged: workload {} has no light", base.workload));
    const glm::dmat4 to_world = glm::inverse(glm::dmat4(area.frame->kbuffer_view->view));
    const glm::dvec3 forward = -glm::dvec3(to_world[2]);
    base.workload_settings = hard_settings(base.workload_settings);
    std::vector<AveragedShadows> result;
    for (std::uint32_t lights = 4; lights <= request.averaged; lights *= 4)
        result.push_back(average(base, *area.frame->light, forward, lights, supervision));
    return result;
}

} // namespace reports
