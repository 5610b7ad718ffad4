#include "pipeline/functional/compose_pass.hpp"

#include "pipeline/functional/kernel_pass.hpp"
#include "pipeline/functional/parallel.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace pipeline {

namespace {

void store_quad(const Pass& pass, const ShaderInput& input, const ShaderOutput& output, SurfaceStore& surfaces) {
    for (std::size_t target = 0; target < pass.targets.size(); ++target) {
        const SurfaceId surface = pass.targets[target];
        if (surface == no_surface) continue;
        for (std::uint32_t i = 0; i < 4; ++i)
            if ((input.pixels >> i & 1U) != 0)
                pack_colour(surfaces.info(surface).format, output.colours[target][i],
                            surfaces.written(surface, {input.x + i % 2, input.y + i / 2, 0}), surfaces.fp16_overflow());
    }
}

} // namespace

void compose(const Pass& pass, SurfaceStore& surfaces, unsigned threads) {
    if (pass.kernel != nullptr) return run_kernel(pass, surfaces, threads);
    CHECK_MSG(pass.writes_colour() && pass.reads.size() == pass.shader->shape().reads,
              fmt::format("pass {}: a picture is made of surfaces that its shader knows", pass.name));
    const std::uint32_t width = surfaces.info(pass.first_target()).width,
                        height = surfaces.info(pass.first_target()).height;
    for (const SurfaceId target : pass.targets)
        CHECK(target == no_surface || (surfaces.info(target).width == width && surfaces.info(target).height == height &&
                                       surfaces.info(target).planes == 1));
    constexpr std::uint32_t strip = SurfaceStore::page_size; // threads do not share pages
    parallel_for(threads, (height + strip - 1) / strip, [&](std::size_t number) {
        SurfaceAccess access(surfaces, pass.reads);
        const std::uint32_t first = static_cast<std::uint32_t>(number) * strip, end = std::min(first + strip, height);
        for (std::uint32_t y = first; y < end; y += 2)
            for (std::uint32_t x = 0; x < width; x += 2) {
                ShaderInput input;
                input.x = x;
                input.y = y;
                input.pixels = (x + 1 < width ? 0b0011U : 0b0001U) | (y + 1 < height ? 0b1100U : 0U);
                if (x + 1 >= width) input.pixels &= 0b0101U;
                ShaderOutput output;
                output.alive = input.pixels;
                pass.shader->shade(input, access, output);
                store_quad(pass, input, output, surfaces);
            }
    });
}

} // namespace pipeline
