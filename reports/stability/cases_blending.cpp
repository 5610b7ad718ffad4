// Blending and compositing: quanta of colour formats, saturation, opacity 0 and 1, thousands of layers against exact
// arithmetic.
#include "models/programs/mlab.hpp"
#include "models/programs/order_and_blend.hpp"
#include "pipeline/functional/fragment_operations.hpp"
#include "pipeline/functional/number_formats.hpp"
#include "reports/stability/catalogue.hpp"
#include "reports/stability/floats.hpp"
#include "reports/stability/quad.hpp"
#include "reports/stability/replay.hpp"
#include "reports/stability/scenes.hpp"
#include "traces/loads.hpp"

#include <fmt/format.h>

namespace reports::stability::blending {

namespace blends = pipeline::blends;
using pipeline::SurfaceFormat;
using Codes = glm::tvec4<std::uint8_t>;

void add_unorm8(std::vector<Case>& cases) {
    // x * 255 is exact in a double; boundaries lie at code + 1/2.
    const auto nearest = [](Finding& finding, bool above) {
        for (int code = 0; code < 255; ++code) {
            auto x = static_cast<float>((code + 0.5) / 255.0);
            while (static_cast<double>(x) * 255.0 >= code + 0.5) x = next_down(x);
            if (above)
                while (static_cast<double>(x) * 255.0 <= code + 0.5) x = next_up(x);
            finding.error(pipeline::float_to_unorm8(x) - (code + (above ? 1 : 0)));
        }
    };
    cases.push_back({"blending.unorm8-below-half", Side::below,
                     "8-bit colours: the last float below each middle of two codes", "the lower code", "1/255", 0.0,
                     [nearest](Finding& finding) { nearest(finding, false); }});
    cases.push_back({"blending.unorm8-tie", Side::at, "8-bit colours: 0.5 is 127.5 steps", "128, the even code",
                     "1/255", 0.0, [](Finding& finding) { finding.error(pipeline::float_to_unorm8(0.5F) - 128); }});
    cases.push_back({"blending.unorm8-above-half", Side::above,
                     "8-bit colours: the first float above each middle of two codes", "the upper code", "1/255", 0.0,
                     [nearest](Finding& finding) { nearest(finding, true); }});
    cases.push_back({"blending.unorm8-not-in-range", Side::above,
                     "8-bit colours: below 0, above 1, infinite, not a number", "0 below and for NaN, 255 above",
                     "1/255", 0.0, [](Finding& finding) {
                         for (const float x : {-smallest_float, -infinity, not_a_number})
                             finding.error(pipeline::float_to_unorm8(x));
                         for (const float x : {next_up(1.0F), infinity})
                             finding.error(pipeline::float_to_unorm8(x) - 255);
                     }});
    cases.push_back({"blending.srgb-round-trip", Side::whole,
                     "sRGB codes to linear light and back, ends and NaN among them",
                     "the same 256 codes, in ascending order", "1/255", 0.0, [](Finding& finding) {
                         const auto& linear = pipeline::srgb_decode_table();
                         for (int code = 0; code < 256; ++code) {
                             finding.error(pipeline::srgb_encode(linear[static_cast<std::size_t>(code)]) - code);
                             if (code > 0)
                                 finding.require(linear[static_cast<std::size_t>(code)] >
                                                     linear[static_cast<std::size_t>(code) - 1],
                                                 "ascending");
                         }
                         finding.error(ulps(linear[255], 1.0F));
                         finding.error(pipeline::srgb_encode(not_a_number));
                         finding.error(pipeline::srgb_encode(infinity) - 255);
                     }});
}

/// One channel of RGBA8 `source over target`, exactly: round(s a / 255) + round(t (255 - a) / 255), by integers.
int exact_over(int source, int alpha, int target) {
    const auto rounded = [](int product) {
        return (2 * product + 255) / 510;
    }; // no product of codes is a tie: 255 is odd
    return std::min(rounded(source * alpha) + rounded(target * (255 - alpha)), 255);
}

void add_products(std::vector<Case>& cases) {
    cases.push_back({"blending.products", Side::whole, "8-bit source over target, every alpha and every target",
                     "round(s a / 255) + round(t (255 - a) / 255) by integers", "1/255", 0.0, [](Finding& finding) {
                         for (int alpha = 0; alpha < 256; ++alpha)
                             for (int target = 0; target < 256; ++target) {
                                 const int source = (alpha * 7 + target * 13) % 256;
                                 const Codes result = pipeline::blended(
                                     blends::over(),
                                     Codes(static_cast<std::uint8_t>(source), 0, 255, static_cast<std::uint8_t>(alpha)),
                                     Codes(static_cast<std::uint8_t>(target), 255, 0, 0));
                                 finding.error(result.r - exact_over(source, alpha, target));
                                 finding.error(result.g - exact_over(0, alpha, 255));
                                 finding.error(result.b - exact_over(255, alpha, 0));
                             }
                     }});
    const auto opacity = [](Finding& finding, float alpha, bool keeps) {
        for (const SurfaceFormat format : {SurfaceFormat::rgba8, SurfaceFormat::rgba16f, SurfaceFormat::rgba32f}) {
            const glm::vec4 stored = pipeline::through_format(format, {0.2F, 0.4F, 0.8F, 0.6F}),
                            source(0.9F, 0.1F, 0.3F, alpha);
            const glm::vec4 result = pipeline::write_colour(format, blends::over(), 15, source, stored);
            const glm::vec4 expected = keeps ? stored : pipeline::through_format(format, source);
            for (int i = 0; i < 3; ++i) finding.error(ulps(result[i], expected[i]));
        }
    };
    cases.push_back({"blending.opacity-0", Side::below, "a fragment of opacity 0, in all colour formats",
                     "the stored colour, bit for bit", "ulp", 0.0,
                     [opacity](Finding& finding) { opacity(finding, 0.0F, true); }});
    cases.push_back({"blending.opacity-half", Side::at, "a fragment of opacity 1/2 of equal colour, in float formats",
                     "that colour, bit for bit", "ulp", 0.0, [](Finding& finding) {
                         for (const SurfaceFormat format : {SurfaceFormat::rgba16f, SurfaceFormat::rgba32f}) {
                             const glm::vec4 colour(0.75F, 1.0F / 1024.0F, 60000.0F, 0.5F);
                             const glm::vec4 result =
                                 pipeline::write_colour(format, blends::over(), 15, colour, colour);
                             for (int i = 0; i < 3; ++i)
                                 finding.error(ulps(result[i], pipeline::through_format(format, colour)[i]));
                         }
                     }});
    cases.push_back({"blending.opacity-1", Side::above, "a fragment of opacity 1, in all colour formats",
                     "the fragment's colour, bit for bit", "ulp", 0.0,
                     [opacity](Finding& finding) { opacity(finding, 1.0F, false); }});
}

void add_saturation(std::vector<Case>& cases) {
    const auto sum = [](Finding& finding, int a, int b) {
        const Codes result = pipeline::blended(blends::of(blends::sum), Codes(static_cast<std::uint8_t>(a)),
                                               Codes(static_cast<std::uint8_t>(b)));
        finding.error(result.r - std::min(a + b, 255));
    };
    cases.push_back(
        {"blending.add-below", Side::below, "8-bit sums of 254", "254", "1/255", 0.0, [sum](Finding& finding) {
             for (int a = 0; a <= 254; ++a) sum(finding, a, 254 - a);
         }});
    cases.push_back({"blending.add-at", Side::at, "8-bit sums of 255", "255", "1/255", 0.0, [sum](Finding& finding) {
                         for (int a = 0; a <= 255; ++a) sum(finding, a, 255 - a);
                     }});
    cases.push_back({"blending.add-above", Side::above, "8-bit sums of 256 to 510", "255: saturated", "1/255", 0.0,
                     [sum](Finding& finding) {
                         for (int a = 1; a <= 255; ++a) {
                             sum(finding, a, 256 - a);
                             sum(finding, a, 255);
                         }
                     }});
    const auto largest = [](Finding& finding, SurfaceFormat format, float a, float b, float expected) {
        const glm::vec4 result = pipeline::write_colour(format, blends::of(blends::sum), 15, glm::vec4(a),
                                                        pipeline::through_format(format, glm::vec4(b)));
        finding.error(ulps(result.r, expected));
    };
    cases.push_back({"blending.add-floats-below", Side::below, "sums just below what float formats hold", "the sum",
                     "ulp", 0.0, [largest](Finding& finding) {
                         largest(finding, SurfaceFormat::rgba16f, 32.0F, 65440.0F, 65472.0F);
                         largest(finding, SurfaceFormat::rgba32f, 0x1p126F, 0x1p126F, 0x1p127F);
                     }});
    cases.push_back({"blending.add-floats-at", Side::at, "sums that are the largest finite value", "that value", "ulp",
                     0.0, [largest](Finding& finding) {
                         largest(finding, SurfaceFormat::rgba16f, 32.0F, 65472.0F, 65504.0F);
                         largest(finding, SurfaceFormat::rgba32f, 0x1p127F,
                                 0x1.FFFFFCp126F * 1.0F + 0x1p104F - 0x1p104F, 0x1p127F + 0x1.FFFFFCp126F);
                     }});
    cases.push_back({"blending.add-floats-above", Side::above, "sums beyond, infinite and NaN sources",
                     "the largest finite value; 0 for NaN", "ulp", 0.0, [largest](Finding& finding) {
                         largest(finding, SurfaceFormat::rgba16f, 65504.0F, 65504.0F, 65504.0F);
                         largest(finding, SurfaceFormat::rgba32f, largest_float, largest_float, largest_float);
                         for (const SurfaceFormat format : {SurfaceFormat::rgba16f, SurfaceFormat::rgba32f}) {
                             const float most = format == SurfaceFormat::rgba16f ? 65504.0F : largest_float;
                             largest(finding, format, infinity, 1.0F, most);
                             largest(finding, format, -infinity, 1.0F, -most);
                             largest(finding, format, not_a_number, 1.0F, 0.0F);
                         }
                     }});
}

constexpr int many = 10000;

/// C = C (1 - a) + a c, 10,000 times, in 113 bits: the value that exact blending of a float surface tends to.
Quad exact_accumulation(Quad alpha, bool alternate) {
    Quad colour = 1;
    for (int i = 0; i < many; ++i)
        colour = colour * (1 - alpha) + alpha * (alternate && i % 2 == 0 ? Quad(0) : Quad(1) / 4);
    return colour;
}

void add_many_layers(std::vector<Case>& cases) {
    cases.push_back({"blending.10000-rgba8", Side::whole, "10,000 layers blended into RGBA8 with alpha 16/255",
                     "the same by integers, step by step", "1/255", 0.0, [](Finding& finding) {
                         glm::vec4 stored(1.0F);
                         int exact = 255;
                         for (int i = 0; i < many; ++i) {
                             const int source = i % 2 == 0 ? 0 : 64;
                             stored = pipeline::write_colour(
                                 SurfaceFormat::rgba8, blends::over(), 15,
                                 glm::vec4(glm::vec3(static_cast<float>(source) / 255.0F), 16.0F / 255.0F), stored);
                             exact = exact_over(source, 16, exact);
                             finding.error(std::round(static_cast<double>(stored.r) * 255.0) - exact);
                         }
                     }});
    cases.push_back(
        {"blending.10000-rgba32f", Side::whole, "10,000 layers blended into RGBA32F, alpha 1/16 to 1/1024",
         "113-bit accumulation; an error of half a float per step shrinks by 1 - alpha: 3 (1/alpha) 2^-24 at most",
         "of that", 1.0, [](Finding& finding) {
             for (const float alpha : {0x1p-4F, 0x1p-7F, 0x1p-10F}) {
                 glm::vec4 stored(1.0F);
                 for (int i = 0; i < many; ++i)
                     stored = pipeline::write_colour(SurfaceFormat::rgba32f, blends::over(), 15,
                                                     glm::vec4(glm::vec3(i % 2 == 0 ? 0.0F : 0.25F), alpha), stored);
                 const double bound = 3.0 / static_cast<double>(alpha) * 0x1p-24;
                 finding.error(
                     relative_error(static_cast<double>(stored.r), exact_accumulation(static_cast<Quad>(alpha), true)) /
                     bound);
             }
         }});
    cases.push_back(
        {"blending.10000-rgba16f", Side::whole,
         "10,000 layers blended into RGBA16F with alpha 1/1024: each step is less than half a quantum from 0.5 on",
         "it sticks where alpha (C - c) is half a quantum, not at c: 113-bit accumulation says 0.25", "1/255", 64.0,
         [](Finding& finding) {
             glm::vec4 stored(1.0F);
             for (int i = 0; i < many; ++i)
                 stored = pipeline::write_colour(SurfaceFormat::rgba16f, blends::over(), 15,
                                                 glm::vec4(glm::vec3(0.25F), 0x1p-10F), stored);
             // A step moves C by (C - 1/4) / 1024; the quantum in [0.5, 1) is 2^-11, in [0.25, 0.5) 2^-12.
             const double exact = static_cast<double>(exact_accumulation(0x1p-10F, false));
             finding.error((static_cast<double>(stored.r) - exact) * 255.0);
             finding.require(stored.r >= 0.25F && stored.r <= 0.5F, "between 1/4 and 1/2");
             finding.outcome(fmt::format("sticks at {}, exactly it is {:.4f}", stored.r, exact));
         }});
    const auto layers = [](Finding& finding, float opacity, double bound_per_layer) {
        for (const bool nodes : {false, true}) {
            const auto program = nodes ? models::make_mlab(8, opacity) : models::make_order_and_blend(8, opacity);
            std::vector<float> pixel(program->floats_per_pixel()), entry(program->floats_per_entry());
            program->clear(pixel.data());
            for (int i = 0; i < many; ++i) {
                const std::array<float, 4> rgba{0.25F, 0.5F, 1.0F, 1.0F};
                program->make_entry({rgba.data(), static_cast<float>(i) / many, 0}, entry.data());
                program->insert(pixel.data(), entry.data());
            }
            if (program->drains()) program->drain(pixel.data());
            // All layers alike: c (1 - (1 - a)^n), the transmittance (1 - a)^n.
            Quad through = 1;
            for (int i = 0; i < many; ++i) through *= 1 - Quad(opacity);
            double red = 0.0;
            if (nodes) { // composite the nodes: premultiplied colour, transmittance
                double left = 1.0;
                for (std::uint32_t i = 0; i < program->k(); ++i) {
                    red += left * static_cast<double>(pixel[std::size_t{i} * 5]);
                    left *= static_cast<double>(pixel[i * 5 + 3]);
                }
            } else {
                red = static_cast<double>(pixel[std::size_t{program->k()} * 4]);
            }
            const Quad exact = Quad(0.25F) * (1 - through);
            finding.error((red - static_cast<double>(exact)) / (opacity == 0.0F ? 1.0 : bound_per_layer));
        }
    };
    cases.push_back({"blending.10000-composited-0", Side::below,
                     "10,000 layers of opacity 0 composited by A7 and by nodes", "nothing: exactly 0", "absolute", 0.0,
                     [layers](Finding& finding) { layers(finding, 0.0F, 1.0); }});
    cases.push_back({"blending.10000-composited", Side::at,
                     "10,000 layers of opacity 1e-4, 1e-3 and 0.5 composited by A7 and by nodes",
                     "c (1 - (1 - a)^10000) in 113 bits, within 10,000 roundings of a float's last place", "of that",
                     1.0, [layers](Finding& finding) {
                         for (const float opacity : {1e-4F, 1e-3F, 0.5F})
                             layers(finding, opacity, many * 0x1p-25 * 0.25);
                     }});
    cases.push_back({"blending.10000-composited-1", Side::above,
                     "10,000 layers of opacity 1 composited by A7 and by nodes", "the first one's colour, exactly",
                     "absolute", 0.0, [layers](Finding& finding) { layers(finding, 1.0F, 1.0); }});
    cases.push_back(
        {"blending.10000-frame", Side::whole,
         "a frame of 10,000 layers over 4x4 pixels blended in RGBA32F by the ROP, opacity 1/16",
         "113-bit accumulation of the same layers", "1/255", 0.01, [](Finding& finding) {
             traces::Load load = traces::blending_load("rgba32f");
             load.settings.emplace_back("opacity=0.0625");
             const Replay replay(
                 "gen:stack?n=10000&x=0&y=0&w=4&h=4&order=back-to-front",
                 {.width = 4, .height = 4, .workload = load.workload, .knobs = load.settings, .threads = 1});
             const pipeline::RunResult run = replay.run("existing");
             finding.require(run.wrong_pixels == 0, "equals the frame in submission order");
             std::array<Quad, 3> exact{1, 1, 1};
             const auto& stream = replay.streams[0];
             finding.require(stream.colours.at(0)[0].a == 0.0625F, "the opacity is in the fragments");
             for (std::size_t i = 0; i < stream.quads.size(); ++i) {
                 const pipeline::Quad& quad = stream.quads[i];
                 if (quad.x != 0 || quad.y != 0 || (quad.alive & 1U) == 0) continue;
                 const glm::vec4 colour = stream.colours[i][0];
                 for (std::size_t c = 0; c < 3; ++c)
                     exact[c] = exact[c] * (1 - Quad(colour.a)) + Quad(colour[static_cast<int>(c)]) * Quad(colour.a);
             }
             for (std::size_t c = 0; c < 3; ++c)
                 finding.error((static_cast<double>(run.colour[c]) - static_cast<double>(exact[c])) * 255.0);
         }});
    const auto frame = [](Finding& finding, const char* program, const char* opacity, std::size_t layers_seen) {
        const std::array depths{0.25F, 0.5F, 0.75F};
        const Replay replay(layers_of(4, 4, depths),
                            {.width = 4,
                             .height = 4,
                             .knobs = {std::string("program=") + program, std::string("opacity=") + opacity},
                             .threads = 1});
        const pipeline::RunResult run = replay.run("blender");
        finding.require(run.wrong_pixels == 0, "equals the reference");
        const glm::vec4 first = replay.streams[0].colours[0][0];
        const glm::vec3 expected = layers_seen == 0 ? glm::vec3(1.0F) : glm::vec3(first);
        for (int c = 0; c < 3; ++c)
            finding.error(ulps(replay.reference.picture[static_cast<std::size_t>(c)], expected[c]));
    };
    cases.push_back({"blending.frame-opacity-0", Side::below,
                     "frames of three layers of opacity 0: nearest-k, A7, nodes", "the white behind them, bit for bit",
                     "ulp", 0.0, [frame](Finding& finding) {
                         for (const char* program : {"nearest-k", "order-and-blend", "mlab"})
                             frame(finding, program, "0", 0);
                     }});
    cases.push_back({"blending.frame-opacity-1", Side::above,
                     "frames of three layers of opacity 1: nearest-k, A7, nodes", "the layer in front, bit for bit",
                     "ulp", 0.0, [frame](Finding& finding) {
                         for (const char* program : {"nearest-k", "order-and-blend", "mlab"})
                             frame(finding, program, "1", 1);
                     }});
    cases.push_back({"blending.transmittance-underflow", Side::above,
                     "300 layers of opacity 1/2: the transmittance 2^-300 is no float",
                     "0, and the colour is that of the layers", "ulp", 1.0, [](Finding& finding) {
                         const auto program = models::make_order_and_blend(4, 0.5F);
                         std::vector<float> pixel(program->floats_per_pixel());
                         program->clear(pixel.data());
                         for (int i = 0; i < 300; ++i) {
                             const std::array<float, 4> entry{1.0F, 0.0F, 0.5F, static_cast<float>(i) / 300.0F};
                             program->insert(pixel.data(), entry.data());
                         }
                         program->drain(pixel.data());
                         finding.error(ulps(pixel[16], 1.0F));
                         finding.error(static_cast<double>(pixel[17]));
                         finding.error(ulps(pixel[18], 0.5F));
                         finding.error(static_cast<double>(pixel[19]));
                     }});
}

} // namespace reports::stability::blending

std::vector<reports::stability::Case> reports::stability::blending_cases() {
    std::vector<Case> cases;
    blending::add_unorm8(cases);
    blending::add_products(cases);
    blending::add_saturation(cases);
    blending::add_many_layers(cases);
    return cases;
}
