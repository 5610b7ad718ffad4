// Depth surfaces and 16-bit floats at their quanta, and what is no depth at all.
#include "pipeline/functional/number_formats.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/raster_state.hpp"
#include "reports/stability/catalogue.hpp"
#include "reports/stability/floats.hpp"
#include "reports/stability/quad.hpp"
#include "traces/shadows/shadow_map.hpp"

#include <fmt/format.h>

namespace reports::stability::depth_formats {

using pipeline::depth_code;
using pipeline::depth_value;
using pipeline::SurfaceFormat;

bool less(pipeline::DepthCode incoming, pipeline::DepthCode stored) {
    return passes(pipeline::DepthState().compare, incoming, stored);
}

std::int64_t steps_of(SurfaceFormat format) { return format == SurfaceFormat::d16 ? 65535 : 16777215; }
const char* name_of(SurfaceFormat format) { return format == SurfaceFormat::d16 ? "d16" : "d24"; }

/// The largest float below (code + 1/2) / steps, in exact arithmetic: x * 2 * steps is an integer of 49 bits times a
/// power of two, which a Quad holds.
float below_boundary(SurfaceFormat format, std::int64_t code) {
    auto x = static_cast<float>((static_cast<double>(code) + 0.5) / static_cast<double>(steps_of(format)));
    const Quad boundary = 2 * Quad(code) + 1;
    while (Quad(x) * 2 * steps_of(format) >= boundary) x = next_down(x);
    while (Quad(next_up(x)) * 2 * steps_of(format) < boundary) x = next_up(x);
    return x;
}

/// Boundaries of a few thousand codes, the first and the last among them; `up` floats behind the last one below.
/// In [0.5, 1) a D24 step is a float, so not every boundary there has a float on either side of it.
void boundaries(Finding& finding, SurfaceFormat format, bool above) {
    const std::int64_t last = steps_of(format) - 1, step = std::max<std::int64_t>(1, last / 4099);
    for (std::int64_t code = 0; code <= last; code = code < last && code + step > last ? last : code + step) {
        const float below = below_boundary(format, code);
        float x = below;
        if (above) do
                x = next_up(x);
            while (Quad(x) * 2 * steps_of(format) == 2 * Quad(code) + 1);
        const Quad place = Quad(x) * steps_of(format); // the code is the nearest integer
        const auto want = static_cast<std::int64_t>(place + Quad(1) / 2);
        finding.error(static_cast<double>(depth_code(format, x)) - static_cast<double>(want));
        if (code == last) break;
    }
}

void every_code_comes_back(Finding& finding, SurfaceFormat format) {
    const auto last = static_cast<std::uint32_t>(steps_of(format));
    const std::uint32_t step = format == SurfaceFormat::d16 ? 1 : 13; // 13 and 2^24 - 1 have no common factor
    for (std::uint32_t code = 0; code <= last; code += step)
        finding.error(static_cast<double>(depth_code(format, depth_value(format, code))) - code);
    finding.error(static_cast<double>(depth_code(format, depth_value(format, last))) - last);
}

Case tie(SurfaceFormat format) {
    return {fmt::format("depth-formats.{}-tie", name_of(format)),
            Side::at,
            "a depth exactly between two codes: 0.5 is half of an odd number of steps",
            "the even one of the two codes",
            fmt::format("D{} units", name_of(format) + 1),
            0.0,
            [format](Finding& finding) {
                const std::int64_t twice = steps_of(format); // 0.5 * steps = twice / 2
                const std::int64_t even = twice / 2 % 2 == 0 ? twice / 2 : twice / 2 + 1;
                finding.error(static_cast<double>(depth_code(format, 0.5F)) - static_cast<double>(even));
            }};
}

void add_fixed_point(std::vector<Case>& cases, SurfaceFormat format) {
    const std::string name = name_of(format), unit = fmt::format("D{} units", name.substr(1));
    cases.push_back({fmt::format("depth-formats.{}-below-half", name), Side::below,
                     "the last float below the middle between two codes", "the lower code, for 4,099 codes", unit, 0.0,
                     [format](Finding& finding) { boundaries(finding, format, false); }});
    cases.push_back(tie(format));
    cases.push_back({fmt::format("depth-formats.{}-above-half", name), Side::above,
                     "the first float above the middle between two codes", "the upper code, for 4,099 codes", unit, 0.0,
                     [format](Finding& finding) { boundaries(finding, format, true); }});
    cases.push_back({fmt::format("depth-formats.{}-round-trip", name), Side::whole,
                     "reading a code and storing it again", "the same code", unit, 0.0,
                     [format](Finding& finding) { every_code_comes_back(finding, format); }});
    cases.push_back({fmt::format("depth-formats.{}-not-in-range", name), Side::above,
                     "depths beyond 0 and 1, infinite and not a number", "0 below and for NaN, the last code above",
                     unit, 0.0, [format](Finding& finding) {
                         const auto last = static_cast<double>(steps_of(format));
                         for (const float x : {-0.0F, -smallest_float, -1.0F, -infinity, not_a_number})
                             finding.error(depth_code(format, x));
                         for (const float x : {1.0F, next_up(1.0F), 2.0F, largest_float, infinity})
                             finding.error(static_cast<double>(depth_code(format, x)) - last);
                     }});
}

void add_d32f(std::vector<Case>& cases) {
    const auto code = [](float x) { return depth_code(SurfaceFormat::d32f, x); };
    cases.push_back({"depth-formats.d32f-below-zero", Side::below, "the float before 0, and -0", "the code of +0",
                     "ulp", 0.0, [code](Finding& finding) {
                         finding.error(code(-smallest_float));
                         finding.error(code(-0.0F));
                     }});
    cases.push_back({"depth-formats.d32f-quanta", Side::at, "neighbouring floats, from the smallest to 1",
                     "codes that differ by 1, in order", "ulp", 0.0, [code](Finding& finding) {
                         for (float x = smallest_float; x < 1.0F; x = x * 1.37F + smallest_float)
                             finding.error(static_cast<double>(code(next_up(x))) - static_cast<double>(code(x)) - 1.0);
                     }});
    cases.push_back({"depth-formats.d32f-above-one", Side::above, "the float behind 1, infinity, and NaN",
                     "the code of 1, and that of 0 for NaN", "ulp", 0.0, [code](Finding& finding) {
                         const double one = code(1.0F);
                         finding.error(one - 0x3F800000);
                         for (const float x : {next_up(1.0F), infinity}) finding.error(code(x) - one);
                         finding.error(code(not_a_number));
                     }});
    cases.push_back(
        {"depth-formats.codes-order-as-depths", Side::whole, "the depth test compares codes, not depths",
         "of two depths the nearer never has the greater code, in all formats", "", 0.0, [](Finding& finding) {
             for (const SurfaceFormat format : {SurfaceFormat::d16, SurfaceFormat::d24, SurfaceFormat::d32f}) {
                 pipeline::DepthCode before = 0;
                 for (float x = 0.0F; x <= 1.0F; x = next_up(x * 1.0001F)) {
                     const pipeline::DepthCode now = depth_code(format, x);
                     finding.require(now >= before, fmt::format("code of {} grows", x));
                     finding.require(!less(now, before), "no later one is less");
                     before = now;
                 }
             }
         }});
    cases.push_back({"depth-formats.equal-is-not-less", Side::at, "two equal codes under the strict test",
                     "the stored one stays", "", 0.0, [](Finding& finding) {
                         for (const pipeline::DepthCode x : {0U, 1U, 65535U, 16777215U})
                             finding.require(!less(x, x), fmt::format("{} is not less", x));
                         finding.require(less(0, 1), "0 is less than 1");
                     }});
}

float through_half(float value) { return pipeline::half_to_float(pipeline::float_to_half(value)); }

/// At every power of two that a half holds: `share` of a quantum above an odd multiple; `want` quanta are expected.
void half_quanta(Finding& finding, float share, double want) {
    for (int exponent = -14; exponent <= 15; ++exponent) {
        const double quantum = std::exp2(exponent - 10), base = std::exp2(exponent) + quantum; // an odd multiple
        if (base + quantum > 65504.0) continue;
        const auto x = static_cast<float>(base + static_cast<double>(share) * quantum);
        finding.error((static_cast<double>(through_half(x)) - base) / quantum - want);
    }
}

void add_halves(std::vector<Case>& cases) {
    cases.push_back({"half.below-half-quantum", Side::below, "16-bit floats: 0.499 of a quantum above an odd code",
                     "the odd code, in all binades", "half quanta", 0.0,
                     [](Finding& finding) { half_quanta(finding, 0.499F, 0.0); }});
    cases.push_back({"half.tie", Side::at, "16-bit floats: half a quantum above an odd code", "the even code above",
                     "half quanta", 0.0, [](Finding& finding) { half_quanta(finding, 0.5F, 1.0); }});
    cases.push_back({"half.above-half-quantum", Side::above, "16-bit floats: 0.501 of a quantum above an odd code",
                     "the code above", "half quanta", 0.0,
                     [](Finding& finding) { half_quanta(finding, 0.501F, 1.0); }});
    cases.push_back(
        {"half.subnormal-below", Side::below, "the last float below 2^-25, half of the least half", "0", "2^-24", 0.0,
         [](Finding& finding) { finding.error(static_cast<double>(through_half(next_down(0x1p-25F))) * 0x1p24); }});
    cases.push_back({"half.subnormal-tie", Side::at, "2^-25 and 3 * 2^-25, ties between subnormals",
                     "0 and 2^-23: the even ones", "2^-24", 0.0, [](Finding& finding) {
                         finding.error(static_cast<double>(through_half(0x1p-25F)) * 0x1p24);
                         finding.error(static_cast<double>(through_half(0x3p-25F)) * 0x1p24 - 2.0);
                     }});
    cases.push_back(
        {"half.subnormal-above", Side::above, "the first float above 2^-25", "2^-24", "2^-24", 0.0,
         [](Finding& finding) { finding.error(static_cast<double>(through_half(next_up(0x1p-25F))) * 0x1p24 - 1.0); }});
    cases.push_back({"half.round-trip", Side::whole, "all 65,536 halves to floats and back",
                     "the same bits; NaNs stay NaNs", "", 0.0, [](Finding& finding) {
                         for (std::uint32_t bits = 0; bits < 65536; ++bits) {
                             const auto half = static_cast<std::uint16_t>(bits);
                             const float value = pipeline::half_to_float(half);
                             const std::uint16_t back = pipeline::float_to_half(value);
                             finding.require(std::isnan(value) ? std::isnan(pipeline::half_to_float(back))
                                                               : back == half,
                                             fmt::format("half {:#06x} comes back", bits));
                         }
                     }});
    const auto stored = [](float x) { return traces::through_shadow_format(traces::ShadowFormat::rgba16f, x); };
    cases.push_back({"half.largest-below", Side::below, "the last float below 65520, where halves end", "65504", "ulp",
                     0.0, [stored](Finding& finding) {
                         finding.error(ulps(stored(next_down(65520.0F)), 65504.0F));
                         finding.error(ulps(through_half(next_down(65520.0F)), 65504.0F));
                     }});
    cases.push_back({"half.largest-at", Side::at, "65520: a half overflows here",
                     "infinite as a number, 65504 in a shadow map", "ulp", 0.0, [stored](Finding& finding) {
                         finding.require(through_half(65520.0F) == infinity, "65520 is infinite as a half");
                         finding.error(ulps(stored(65520.0F), 65504.0F));
                     }});
    cases.push_back({"half.largest-above", Side::above, "1e30 and infinity in a shadow map of halves",
                     "65504, the sentinel of an empty layer", "ulp", 0.0, [stored](Finding& finding) {
                         for (const float x : {1e30F, infinity}) finding.error(ulps(stored(x), 65504.0F));
                         for (const float x : {-1e30F, -infinity}) finding.error(ulps(stored(x), -65504.0F));
                     }});
}

} // namespace reports::stability::depth_formats

std::vector<reports::stability::Case> reports::stability::depth_format_cases() {
    std::vector<Case> cases;
    depth_formats::add_fixed_point(cases, pipeline::SurfaceFormat::d16);
    depth_formats::add_fixed_point(cases, pipeline::SurfaceFormat::d24);
    depth_formats::add_d32f(cases);
    depth_formats::add_halves(cases);
    return cases;
}
