// 16-bit floats at the end of their range, as the ROPs store blended colours in them. Source: IEEE 754-2008, section
// 4.3.1: from 65504 + 16 on, the middle to what would be the next, numbers round to infinity.
#include "pipeline/functional/fragment_operations.hpp"
#include "reports/stability/catalogue.hpp"
#include "reports/stability/floats.hpp"
#include "reports/stability/replay.hpp"
#include "reports/stability/scenes.hpp"
#include "traces/loads.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports::stability::halves {

namespace blends = pipeline::blends;
using pipeline::Fp16Overflow;
using pipeline::SurfaceFormat;

/// A stored half plus `source`, in each format and with either sign: what both settings of rop.fp16_overflow hold then,
/// and whether the channels are counted.
void expect_half_sum(Finding& finding, float source, float stored, float saturated, float infinite) {
    for (const SurfaceFormat format : {SurfaceFormat::r16f, SurfaceFormat::rg16f, SurfaceFormat::rgba16f})
        for (const Fp16Overflow overflow : {Fp16Overflow::saturate, Fp16Overflow::infinity})
            for (const float sign : {1.0F, -1.0F}) {
                std::uint64_t counted = 0;
                const glm::vec4 result =
                    pipeline::write_colour(format, blends::of(blends::sum), 15, glm::vec4(sign * source),
                                           glm::vec4(sign * stored), overflow, &counted);
                finding.error(ulps(result.r, sign * (overflow == Fp16Overflow::saturate ? saturated : infinite)));
                const bool beyond = infinite == infinity;
                finding.require(counted == (beyond ? info_of(format).channels : 0U), "channels beyond are counted");
            }
}

/// Two layers of this brightness, added up by the ROP.
void expect_half_frame(Finding& finding, float brightness, float saturated, float infinite) {
    traces::Scene scene = world_scene({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}});
    scene.resources->materials[0].base_colour = glm::vec4(glm::vec3(brightness), 1.0F);
    traces::Load load = traces::blending_load("rgba16f");
    load.settings.insert(load.settings.end(), {"mode=add", "background=[0,0,0]"});
    const Replay replay(scene,
                        {.width = 16, .height = 16, .workload = load.workload, .knobs = load.settings, .threads = 1});
    for (const bool saturates : {true, false}) {
        const pipeline::RunResult run =
            replay.run("existing", {fmt::format("rop.fp16_overflow={}", saturates ? "saturate" : "infinity")});
        finding.require(run.wrong_pixels == 0, "equals the frame in submission order");
        finding.error(ulps(*std::max_element(run.colour.begin(), run.colour.end()), saturates ? saturated : infinite));
        finding.require((run.stages->at("rop")["counters"]["fp16_overflows"] != 0) == (infinite == infinity),
                        "channels beyond are counted");
    }
}

} // namespace reports::stability::halves

std::vector<reports::stability::Case> reports::stability::half_cases() {
    using namespace halves;
    std::vector<Case> cases;
    constexpr float most = 65504.0F;
    cases.push_back({"halves.below", Side::below, "16-bit floats: sums up to the last float below 65520",
                     "65504, whatever rop.fp16_overflow says; nothing is counted", "ulp", 0.0, [](Finding& finding) {
                         expect_half_sum(finding, 0.0F, most, most, most);
                         expect_half_sum(finding, 16.0F - 0x1p-8F, most, most, most);
                         expect_half_frame(finding, most / 2, most, most);
                     }});
    cases.push_back({"halves.at", Side::at, "16-bit floats: a sum of 65520, which IEEE 754 makes infinite",
                     "65504 or infinity, as rop.fp16_overflow says; each channel is counted", "ulp", 0.0,
                     [](Finding& finding) {
                         expect_half_sum(finding, 16.0F, most, most, infinity);
                         expect_half_sum(finding, 65520.0F, 0.0F, most, infinity);
                     }});
    cases.push_back(
        {"halves.above", Side::above,
         "16-bit floats: sums far beyond, infinite and NaN sources, what is blended over infinity",
         "65504 and 0, or infinity and NaN, as rop.fp16_overflow says", "ulp", 0.0, [](Finding& finding) {
             expect_half_sum(finding, most, most, most, infinity);
             expect_half_sum(finding, infinity, 0.0F, most, infinity);
             expect_half_frame(finding, most, most, infinity);
             const glm::vec4 opaque(1.0F), infinite(infinity); // 1 * 1 + infinity * 0
             const auto over = [&](const glm::vec4& source, const glm::vec4& stored, Fp16Overflow overflow) {
                 return pipeline::write_colour(SurfaceFormat::rgba16f, blends::over(), 15, source, stored, overflow).r;
             };
             for (const auto& [source, stored] :
                  {std::pair(opaque, infinite), std::pair(glm::vec4(not_a_number), opaque)}) {
                 finding.require(std::isnan(over(source, stored, Fp16Overflow::infinity)), "NaN stays");
                 finding.error(ulps(over(source, stored, Fp16Overflow::saturate), 0.0F));
             }
         }});
    return cases;
}
