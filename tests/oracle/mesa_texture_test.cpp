// The sampler of recorded textures against Mesa's llvmpipe, isotropic. It filters 8-bit textures with weights of 8
// bits, so that filtered values may be one code of 8 bits away; where it blends two levels it moves the place of the
// blend (up to a quarter of a level), hence four codes for textures whose levels look alike.
#include "tests/support/oracle_textures.hpp"
#include "tests/support/texture_pictures.hpp"

#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace mesa_texture_test {

using pipeline::Filter;
using pipeline::SurfaceFormat;
using pipeline::TextureKind;
using pipeline::Wrap;
using tests::difference_of;
using tests::LinearPlace;
using tests::MesaShaders;
using tests::MesaTexture;
using tests::PictureDifference;
using traces::SurfaceKind;

constexpr int pixels = MesaShaders::size * MesaShaders::size;

class MesaTextures : public testing::Test {
  protected:
    static void SetUpTestSuite() { mesa_ = MesaShaders::create(reason_).release(); }
    static void TearDownTestSuite() {
        delete mesa_;
        mesa_ = nullptr;
    }
    void SetUp() override {
        if (mesa_ == nullptr) GTEST_SKIP() << "no OpenGL to compare with: " << reason_;
    }

    /// All but `most` pixels within so many codes of 8 bits: these lie where a texel, a level or a comparison changes.
    void compare(const std::string& what, const MesaTexture& texture, TextureKind kind, const LinearPlace& place,
                 long codes, int most = 0, bool arrayed = false) {
        const auto [sampler, expression] = glsl_of(kind, arrayed, texture.sampler.compares);
        const bool compares = texture.sampler.compares;
        const auto own =
            tests::own_texture_picture(texture, kind, arrayed, place, [&](pipeline::TextureLookup& lookup) {
                lookup.compares = compares;
                lookup.reference = lookup.place[kind == TextureKind::cube ? 3 : 2];
            });
        auto theirs = tests::mesa_texture_picture(*mesa_, texture, sampler, expression, place);
        if (compares) // they give vec4(result)
            for (glm::vec4& colour : theirs) colour = glm::vec4(colour.r);
        const PictureDifference difference = difference_of(own, theirs, codes);
        EXPECT_LE(difference.pixels, most) << what << ": worst " << difference.worst << "/255";
        if (difference.pixels == 0) worst_ = std::max(worst_, difference.worst);
    }

    static std::pair<std::string, std::string> glsl_of(TextureKind kind, bool arrayed, bool compares) {
        if (kind == TextureKind::cube)
            return compares ? std::pair{"samplerCubeShadow", "vec4(texture(t, place))"}
                            : std::pair{"samplerCube", "texture(t, place.xyz)"};
        if (kind == TextureKind::volume) return {"sampler3D", "texture(t, place.xyz)"};
        if (kind == TextureKind::rectangle) return {"sampler2DRect", "texture(t, place.xy)"};
        if (arrayed) return {"sampler2DArray", "texture(t, place.xyz)"};
        return compares ? std::pair{"sampler2DShadow", "vec4(texture(t, place.xyz))"}
                        : std::pair{"sampler2D", "texture(t, place.xy)"};
    }

    static inline MesaShaders* mesa_ = nullptr;
    static inline std::string reason_;
    double worst_ = 0; ///< of pictures that agree
};

glm::vec4 random_colour(std::uint32_t level, std::uint32_t plane, std::uint32_t x, std::uint32_t y) {
    glm::vec4 colour;
    for (std::uint32_t c = 0; c < 4; ++c)
        colour[static_cast<int>(c)] = tests::random_of("texture", (((level * 64 + plane) * 64 + y) * 64 + x) * 4 + c);
    return colour;
}

MesaTexture random_texture(std::uint32_t width, std::uint32_t height, SurfaceFormat format = SurfaceFormat::rgba8,
                           SurfaceKind kind = SurfaceKind::plane, std::uint32_t depth = 1) {
    MesaTexture texture;
    texture.surface.kind = kind;
    texture.surface.format = format;
    texture.surface.width = width;
    texture.surface.height = height;
    texture.surface.depth = depth;
    tests::fill(texture.surface, 1, random_colour);
    texture.sampler.min_filter = texture.sampler.mag_filter = Filter::linear;
    return texture;
}

/// Levels that look alike.
MesaTexture smooth_texture(std::uint32_t width, std::uint32_t height) {
    MesaTexture texture;
    texture.surface.width = width;
    texture.surface.height = height;
    const auto levels = static_cast<std::uint32_t>(std::log2(std::max(width, height))) + 1;
    tests::fill(texture.surface, levels, [&](std::uint32_t level, auto, std::uint32_t x, std::uint32_t y) {
        const double u = (x + 0.5) / std::max(1U, width >> level), v = (y + 0.5) / std::max(1U, height >> level);
        const double a = std::sin(2 * M_PI * u), b = std::cos(2 * M_PI * v);
        return glm::vec4(0.5 + 0.4 * a, 0.5 + 0.4 * b, 0.5 + 0.4 * a * b, 0.5 + 0.03 * level);
    });
    return texture;
}

/// Turned a little; over more than the texture, or less, by `scale`.
LinearPlace turned(float scale) {
    return {{0.47F, 0.53F, 0, 0}, {1.13F * scale, 0.21F * scale, 0, 0}, {-0.17F * scale, 1.07F * scale, 0, 0}};
}

TEST_F(MesaTextures, EveryWrapMagnified) {
    for (const glm::uvec2 size : {glm::uvec2(8, 8), glm::uvec2(13, 7)})
        for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror, Wrap::border})
            for (const Filter filter : {Filter::nearest, Filter::linear}) {
                MesaTexture texture = random_texture(size.x, size.y);
                texture.sampler.wrap_u = texture.sampler.wrap_v = wrap;
                texture.sampler.min_filter = texture.sampler.mag_filter = filter;
                texture.sampler.border = {0.9F, 0.1F, 0.5F, 0.3F};
                compare(fmt::format("{}x{} wrap {} filter {}", size.x, size.y, static_cast<int>(wrap),
                                    static_cast<int>(filter)),
                        texture, TextureKind::plane, turned(1), 1, filter == Filter::nearest ? 5 : 0);
            }
    std::printf("magnified: worst %.3f/255\n", worst_);
}

TEST_F(MesaTextures, EveryMinificationFilter) {
    for (const float scale : {0.35F, 0.5F, 0.62F, 1.3F}) // levels 0.6, 1.2, 1.5 and 2.6
        for (const Filter filter :
             {Filter::nearest, Filter::linear, Filter::nearest_mip_nearest, Filter::linear_mip_nearest,
              Filter::nearest_mip_linear, Filter::linear_mip_linear}) {
            MesaTexture texture = smooth_texture(64, 64);
            texture.sampler.min_filter = filter;
            texture.sampler.mag_filter = Filter::nearest;
            const bool blends = filter == Filter::nearest_mip_linear || filter == Filter::linear_mip_linear;
            const bool nearest = filter == Filter::nearest || filter == Filter::nearest_mip_nearest ||
                                 filter == Filter::nearest_mip_linear;
            compare(fmt::format("scale {} filter {}", scale, static_cast<int>(filter)), texture, TextureKind::plane,
                    turned(scale), blends ? 4 : 1, nearest ? pixels / 50 : 0);
        }
    std::printf("minified: worst %.3f/255\n", worst_);
}

TEST_F(MesaTextures, LevelsOfOtherSizesBiasesAndBounds) {
    const auto run = [&](const char* what, auto change) {
        MesaTexture texture = smooth_texture(100, 46);
        texture.sampler.min_filter = Filter::linear_mip_linear;
        change(texture);
        compare(what, texture, TextureKind::plane, turned(0.45F), 4);
    };
    run("no power of two", [](MesaTexture&) {});
    run("bias", [](MesaTexture& texture) { texture.sampler.lod_bias = 0.75F; });
    run("least", [](MesaTexture& texture) { texture.sampler.least_lod = 2.25F; });
    run("most", [](MesaTexture& texture) { texture.sampler.most_lod = 0.5F; });
    run("base level", [](MesaTexture& texture) { texture.binding.base_level = 2; });
    run("last level", [](MesaTexture& texture) { texture.binding.last_level = 1; });
    run("swizzle", [](MesaTexture& texture) {
        using traces::Swizzle;
        texture.binding.swizzle = {Swizzle::alpha, Swizzle::one, Swizzle::red, Swizzle::zero};
    });
}

TEST_F(MesaTextures, EveryFormat) {
    for (const SurfaceFormat format :
         {SurfaceFormat::r8, SurfaceFormat::rg8, SurfaceFormat::srgb8a8, SurfaceFormat::rgb10a2,
          SurfaceFormat::r11g11b10f, SurfaceFormat::rgba16, SurfaceFormat::rgba8s, SurfaceFormat::rgba16f,
          SurfaceFormat::r32f, SurfaceFormat::rgba32f, SurfaceFormat::d16, SurfaceFormat::d32f}) {
        MesaTexture texture = random_texture(8, 8, format);
        texture.sampler.wrap_u = Wrap::border;
        texture.sampler.border = {0.25F, 0.5F, 0.75F, 0.4F};
        compare(std::string(pipeline::info_of(format).name), texture, TextureKind::plane, turned(1), 1);
    }
    std::printf("formats: worst %.3f/255\n", worst_);
}

TEST_F(MesaTextures, VolumesLayersAndRectangles) {
    LinearPlace place = turned(0.6F);
    place.base.z = 0.5F;
    place.right.z = 0.8F;
    place.up.z = -0.5F;
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror, Wrap::border}) {
        MesaTexture texture = random_texture(8, 5, SurfaceFormat::rgba8, SurfaceKind::volume, 6);
        texture.sampler.wrap_u = texture.sampler.wrap_v = texture.sampler.wrap_w = wrap;
        compare(fmt::format("volume, wrap {}", static_cast<int>(wrap)), texture, TextureKind::volume, place, 1);
    }
    place.base.z = 1.3F;
    place.right.z = 2.1F;
    MesaTexture layers = random_texture(8, 5, SurfaceFormat::rgba8, SurfaceKind::layers, 4);
    compare("layers", layers, TextureKind::plane, place, 1, 5, true);
    MesaTexture rectangle = random_texture(13, 7);
    rectangle.sampler.wrap_u = rectangle.sampler.wrap_v = rectangle.sampler.wrap_w = Wrap::clamp;
    LinearPlace texels = turned(1);
    for (glm::vec4* part : {&texels.base, &texels.right, &texels.up}) *part *= glm::vec4(13, 7, 0, 0);
    compare("rectangle", rectangle, TextureKind::rectangle, texels, 1);
}

TEST_F(MesaTextures, CubesWithAndWithoutSeams) {
    for (const bool seamless : {true, false})
        for (std::uint32_t view = 0; view < 8; ++view) { // the corners
            MesaTexture texture = random_texture(8, 8, SurfaceFormat::rgba8, SurfaceKind::cube);
            texture.sampler.seamless = seamless;
            texture.sampler.wrap_u = texture.sampler.wrap_v = Wrap::clamp;
            const auto sign = [&](std::uint32_t bit) { return (view >> bit & 1U) == 0 ? 1.0F : -1.0F; };
            const LinearPlace place{{sign(0), sign(1), sign(2), 0},
                                    {0.9F * sign(0), -0.7F * sign(1), -0.3F * sign(2), 0},
                                    {-0.4F * sign(0), -0.45F * sign(1), 0.8F * sign(2), 0}};
            compare(fmt::format("corner {}{}", view, seamless ? "" : ", face by face"), texture, TextureKind::cube,
                    place, 1, pixels / 200);
        }
    std::printf("cubes: worst %.3f/255\n", worst_);
}

TEST_F(MesaTextures, FacesOfEqualComponents) {
    for (const glm::vec3 direction : {glm::vec3(1, 1, 0), glm::vec3(1, 0, 1), glm::vec3(0, 1, 1), glm::vec3(1, 1, 1),
                                      glm::vec3(-1, 1, 0), glm::vec3(1, 0, -1), glm::vec3(0, -1, -1)}) {
        MesaTexture texture = random_texture(1, 1, SurfaceFormat::rgba8, SurfaceKind::cube);
        texture.sampler.min_filter = texture.sampler.mag_filter = Filter::nearest;
        compare(fmt::format("{} {} {}", direction.x, direction.y, direction.z), texture, TextureKind::cube,
                {{direction.x, direction.y, direction.z, 0}, {}, {}}, 1);
    }
}

TEST_F(MesaTextures, ComparisonsOfDepths) {
    LinearPlace place = turned(1);
    place.base.z = 0.5F;
    place.right.z = 0.41F;
    place.up.z = 0.13F;
    for (const SurfaceFormat format : {SurfaceFormat::d16, SurfaceFormat::d32f})
        for (const Filter filter : {Filter::nearest, Filter::linear})
            for (std::uint8_t compared = 0; compared < 8; ++compared) {
                MesaTexture texture = random_texture(8, 8, format);
                texture.sampler.compares = true;
                texture.sampler.compare = static_cast<pipeline::Compare>(compared);
                texture.sampler.min_filter = texture.sampler.mag_filter = filter;
                compare(fmt::format("{} filter {} function {}", pipeline::info_of(format).name,
                                    static_cast<int>(filter), compared),
                        texture, TextureKind::plane, place, 1, filter == Filter::nearest ? 5 : 0);
            }
    std::printf("comparisons: worst %.3f/255\n", worst_);
}

TEST_F(MesaTextures, ComparisonsOnCubes) {
    MesaTexture texture = random_texture(8, 8, SurfaceFormat::d16, SurfaceKind::cube);
    texture.sampler.compares = true;
    compare("cube", texture, TextureKind::cube,
            {{1, 0.9F, -0.8F, 0.5F}, {0.9F, -0.7F, 0.3F, 0.4F}, {-0.4F, 0.2F, 0.8F, 0.1F}}, 1, pixels / 200);
}

} // namespace mesa_texture_test
