// Pictures of k-buffers as shaders of passes that take no time.
#include "models/programs/nearest_k.hpp"
#include "models/programs/order_and_blend.hpp"
#include "models/programs/pictures.hpp"
#include "pipeline/functional/compose_pass.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/functional/surface_values.hpp"
#include "pipeline/sample_planes.hpp"

#include <glm/ext/matrix_clip_space.hpp>
#include <gtest/gtest.h>

namespace programs_pictures_test {

using models::EntryKind;
using pipeline::SurfaceFormat;
using pipeline::SurfaceInfo;
using pipeline::SurfaceStore;

/// A k-buffer, a colour surface of linear floats and the picture of them.
class PictureKit {
  public:
    PictureKit(std::shared_ptr<const pipeline::ModifyProgram> program, std::uint32_t width, std::uint32_t height,
               std::uint32_t samples = 1)
        : store_(surfaces(program, width, height, samples)) {
        setup_.program = std::move(program);
        setup_.view.width = width;
        setup_.view.height = height;
        setup_.view.samples = samples;
        setup_.view.projection = glm::mat4(1.0F);
    }

    models::PictureSetup& setup() { return setup_; }

    void insert(std::uint32_t x, std::uint32_t row, const glm::vec4& colour, float depth) {
        std::array<float, pipeline::largest_entry> entry{};
        setup_.program->make_entry({&colour.x, depth, 0}, entry.data());
        setup_.program->insert(store_.written_entries(0, {x, row, 0}), entry.data());
    }
    void put_behind(std::uint32_t x, std::uint32_t row, const glm::vec4& colour) {
        pack_colour(SurfaceFormat::rgba32f, colour, store_.written(1, {x, row, 0}));
    }

    std::vector<float> picture(const models::MakePicture& make, unsigned threads = 1) {
        pipeline::Pass pass;
        pass.kind = pipeline::PassKind::compose;
        pass.shader = make(setup_);
        pass.reads = {0};
        if (setup_.over_surface) pass.reads.push_back(1);
        pass.targets = {2};
        compose(pass, store_, threads);
        return colours_of(store_, 2);
    }

  private:
    static SurfaceStore surfaces(const std::shared_ptr<const pipeline::ModifyProgram>& program, std::uint32_t width,
                                 std::uint32_t height, std::uint32_t samples) {
        const SurfaceInfo kbuffer{
            .name = "kbuffer", .width = width, .height = height, .planes = samples, .program = program};
        const SurfaceInfo colour{
            .name = "colour", .format = SurfaceFormat::rgba32f, .width = width, .height = height, .planes = samples};
        const SurfaceInfo picture{
            .name = "picture", .format = SurfaceFormat::rgba32f, .width = width, .height = height};
        return SurfaceStore(std::array{kbuffer, colour, picture});
    }

    models::PictureSetup setup_;
    SurfaceStore store_;
};

TEST(Pictures, LayersAreCompositedFrontToBackWithOneOpacity) {
    PictureKit kit(models::make_nearest_k(EntryKind::rgbz, 4), 3, 5);
    kit.setup().background = {0, 0, 1};
    for (std::uint32_t y = 0; y < 5; ++y)
        for (std::uint32_t x = 0; x < 3; ++x) {
            kit.insert(x, y, {0, 1, 0, 1}, 0.75F);
            kit.insert(x, y, {1, 0, 0, 1}, 0.25F);
        }
    const std::vector<float> picture = kit.picture(models::layers_picture(0.25F));
    ASSERT_EQ(picture.size(), 60U);
    for (std::size_t at = 0; at < picture.size(); at += 4) {
        EXPECT_FLOAT_EQ(picture[at], 0.25F);
        EXPECT_FLOAT_EQ(picture[at + 1], 0.75F * 0.25F);
        EXPECT_FLOAT_EQ(picture[at + 2], 0.75F * 0.75F);
        EXPECT_EQ(picture[at + 3], 1.0F);
    }
}

TEST(Pictures, AColourSurfaceLiesBehind) {
    PictureKit kit(models::make_nearest_k(EntryKind::rgbz, 2), 2, 2);
    kit.setup().over_surface = true;
    kit.setup().background = {1, 1, 1}; // is not looked at
    kit.insert(0, 0, {1, 0, 0, 1}, 0.25F);
    kit.put_behind(0, 0, {0, 1, 0, 1});
    kit.put_behind(1, 0, {0, 0.5F, 0, 1});
    const std::vector<float> picture = kit.picture(models::layers_picture(0.5F));
    EXPECT_EQ(std::vector<float>(picture.begin(), picture.begin() + 8),
              (std::vector<float>{0.5F, 0.5F, 0, 1, 0, 0.5F, 0, 1}));
}

TEST(Pictures, LayersOfDepthsAreGreyAndDarkerWithDistance) {
    for (const bool perspective : {false, true}) {
        PictureKit kit(models::make_nearest_k(EntryKind::z, 4), 3, 1);
        kit.setup().background = {0, 0, 0};
        if (perspective) kit.setup().view.projection = glm::perspective(1.0F, 1.0F, 0.5F, 50.0F);
        for (std::uint32_t x = 0; x < 3; ++x) kit.insert(x, 0, glm::vec4(0.0F), static_cast<float>(x) / 2.0F);
        const std::vector<float> picture = kit.picture(models::layers_picture(1.0F));
        EXPECT_NEAR(picture[0], 0.9F, 1e-5F);
        EXPECT_LT(picture[4], picture[0]);
        EXPECT_NEAR(picture[8], 0.1F, 1e-4F);
        EXPECT_EQ(picture[4], picture[5]);
    }
}

TEST(Pictures, SamplesOfAPixelAreAveraged) {
    constexpr std::uint32_t height = 3;
    PictureKit kit(models::make_nearest_k(EntryKind::rgbz, 2), 2, height, 4);
    kit.setup().background = {0, 0, 1};
    for (std::uint32_t sample = 0; sample < 3; ++sample) // all but the last
        kit.insert(1, 2 + sample * pipeline::plane_rows(height, 4), {1, 0, 0, 1}, 0.5F);
    const std::vector<float> picture = kit.picture(models::layers_picture(1.0F));
    const std::size_t at = (2 * 2 + 1) * 4;
    EXPECT_EQ(picture[at], 0.75F);
    EXPECT_EQ(picture[at + 2], 0.25F);
    EXPECT_EQ(picture[at - 4], 0.0F);
    EXPECT_EQ(picture[at - 2], 1.0F);
}

// Two fragments in a queue of four leave with the drain alone, and the k-buffer stays as it is.
TEST(Pictures, ProgramsAreDrainedOnACopy) {
    PictureKit kit(models::make_order_and_blend(4, 0.5F), 1, 1);
    kit.setup().background = {0, 0, 1};
    kit.insert(0, 0, {0, 1, 0, 1}, 0.75F);
    kit.insert(0, 0, {1, 0, 0, 1}, 0.25F);
    for (int again = 0; again < 2; ++again)
        EXPECT_EQ(kit.picture(models::state_picture({0, 1, 2, 3})), (std::vector<float>{0.5F, 0.25F, 0.25F, 1.0F}));
}

TEST(Pictures, AreTheSameForAnyNumberOfThreads) {
    PictureKit kit(models::make_nearest_k(EntryKind::rgbz, 2), 37, 51);
    for (std::uint32_t y = 0; y < 51; ++y)
        for (std::uint32_t x = y % 3; x < 37; x += 2)
            kit.insert(x, y, glm::vec4(0.01F * static_cast<float>(x + y)), 0.5F);
    const std::vector<float> alone = kit.picture(models::layers_picture(0.3F), 1);
    for (const unsigned threads : {2U, 0U}) EXPECT_EQ(kit.picture(models::layers_picture(0.3F), threads), alone);
}

} // namespace programs_pictures_test
