// Every way in which GLSL reads a texture, through the SPIR-V interpreter and the own sampler, against llvmpipe.
#include "sim/check.hpp"
#include "tests/support/spirv_compiler.hpp"
#include "tests/support/texture_pictures.hpp"
#include "traces/glsl.hpp"
#include "traces/recording/textures.hpp"
#include "traces/spirv/quad.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace mesa_texture_calls_test {

using pipeline::Filter;
using tests::LinearPlace;
using tests::MesaShaders;
using tests::MesaTexture;

/// The picture of the shader, run by the interpreter.
std::vector<glm::vec4> interpreted(const std::string& source, const MesaTexture& texture, const LinearPlace& place) {
    const tests::CompiledSpirv spirv = tests::compile_fragment_shader(source);
    EXPECT_EQ(spirv.problem, "") << source;
    const traces::spirv::Module module(spirv.optimised);
    const traces::spirv::Program program(module);
    traces::spirv::Quad quad(program);
    const std::vector<std::uint32_t> uniforms(program.uniform_words);
    quad.set_uniforms(uniforms);

    const pipeline::SurfaceInfo info = traces::surface_of(texture.surface);
    const pipeline::SurfaceStore store(std::span(&info, 1));
    constexpr std::array<pipeline::SurfaceId, 1> slots{0};
    constexpr std::array<std::uint32_t, 1> slot_of_binding{0};
    pipeline::SurfaceAccess access(store, slots);
    const traces::TextureTable table(program, std::span(&texture.binding, 1), std::span(&texture.sampler, 1),
                                     slot_of_binding);
    traces::BoundTextures textures(access, table);

    constexpr std::uint32_t size = MesaShaders::size;
    std::vector<glm::vec4> picture(std::size_t{size} * size);
    const traces::spirv::InterfaceVariable* input = program.input("place");
    const traces::spirv::InterfaceVariable* colour = program.output("colour");
    for (std::uint32_t y = 0; y < size; y += 2)
        for (std::uint32_t x = 0; x < size; x += 2) {
            const auto along = [](std::uint32_t pixel) { return 2 * (static_cast<float>(pixel) + 0.5F) / size - 1; };
            for (std::uint32_t i = 0; input != nullptr && i < 4; ++i) {
                pipeline::Lanes lanes{};
                for (std::uint32_t lane = 0; lane < 4; ++lane)
                    lanes[lane] = place.at(static_cast<int>(i), along(x + lane % 2), along(y + lane / 2));
                quad.set(*input, i, lanes);
            }
            quad.run(textures);
            for (std::uint32_t i = 0; i < 4; ++i) {
                const pipeline::Lanes lanes = quad.get(*colour, i);
                for (std::uint32_t lane = 0; lane < 4; ++lane)
                    picture[std::size_t{y + lane / 2} * size + x + lane % 2][static_cast<int>(i)] = lanes[lane];
            }
        }
    return picture;
}

MesaTexture waves() {
    MesaTexture texture;
    texture.surface.width = 64;
    texture.surface.height = 32;
    tests::fill(texture.surface, 7, [&](std::uint32_t level, auto, std::uint32_t x, std::uint32_t y) {
        const double u = (x + 0.5) / std::max(1U, 64U >> level), v = (y + 0.5) / std::max(1U, 32U >> level);
        const double a = std::sin(2 * M_PI * u), b = std::cos(2 * M_PI * v);
        return glm::vec4(0.5 + 0.4 * a, 0.5 + 0.4 * b, 0.5 + 0.4 * a * b, 0.5 + 0.03 * level);
    });
    texture.sampler.min_filter = Filter::linear_mip_linear;
    texture.sampler.mag_filter = Filter::linear;
    texture.binding.variable = "t";
    return texture;
}

TEST(MesaTextureCalls, EveryCallGivesLlvmpipesColours) {
    std::string reason;
    const std::unique_ptr<MesaShaders> mesa = MesaShaders::create(reason);
    if (!traces::can_compile_glsl()) GTEST_SKIP() << "built without glslang (packages glslang-dev and spirv-tools)";
    if (mesa == nullptr) GTEST_SKIP() << "no OpenGL to compare with: " << reason;
    struct Call {
        const char* expression;
        long codes;   ///< of 8 bits
        int most = 0; ///< pixels beyond it: where texels change
    };
    const LinearPlace place{{0.47F, 0.53F, 0.3F, 0.8F}, {0.9F, 0.2F, 0.1F, 0.1F}, {-0.2F, 1.1F, 0.1F, 0.1F}};
    const MesaTexture texture = waves();
    for (const Call& call :
         {Call{"texture(t, place.xy)", 4}, Call{"texture(t, place.xy, 0.7)", 4},
          Call{"textureLod(t, place.xy, 1.5)", 4}, Call{"textureLod(t, place.xy, 2.0 * place.z)", 4},
          Call{"textureGrad(t, place.xy, vec2(0.05, 0), vec2(0.0, 0.03))", 4},
          Call{"textureOffset(t, place.xy, ivec2(3, -2))", 4}, Call{"textureProj(t, place.xyw)", 4},
          Call{"textureProjLod(t, place.xyw, 1.0)", 1}, Call{"texelFetch(t, ivec2(place.xy * 8.0), 2)", 0, 5},
          Call{"texelFetchOffset(t, ivec2(place.xy * 8.0) + 2, 2, ivec2(-1, 1))", 0, 5},
          Call{"textureGather(t, place.xy)", 0, 20}, Call{"textureGather(t, place.xy, 2)", 0, 20},
          Call{"textureGatherOffset(t, place.xy, ivec2(1, -3), 1)", 0, 20},
          Call{"vec4(textureSize(t, 1), textureQueryLevels(t), 1)", 0},
          Call{"vec4(textureQueryLod(t, place.xy), 0, 1)", 64}}) {
        const std::string source = tests::texture_shader("sampler2D", call.expression);
        const auto own = interpreted(source, texture, place);
        const auto theirs = tests::mesa_texture_picture(*mesa, texture, "sampler2D", call.expression, place);
        const tests::PictureDifference difference = tests::difference_of(own, theirs, call.codes);
        EXPECT_LE(difference.pixels, call.most) << call.expression << ": worst " << difference.worst << "/255";
    }
}

} // namespace mesa_texture_calls_test
