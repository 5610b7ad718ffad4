// Pixels of several samples: which samples a triangle covers, their depths, the group's colour, the mean.
// Source: Vulkan 1.3, standard sample locations; the laws of coverage as for pixel centres.
#include "pipeline/functional/frame_streams.hpp"
#include "pipeline/functional/sample_pattern.hpp"
#include "pipeline/output/surface_layout.hpp"
#include "pipeline/reference.hpp"
#include "sim/check.hpp"
#include "sim/random.hpp"
#include "tests/support/functional_scene.hpp"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <set>

namespace {

using pipeline::FragmentStream;
using pipeline::Quad;
using pipeline::SampleOffset;
using tests::FunctionalScene;
using tests::MeshData;

constexpr std::uint32_t side = 32;

FunctionalScene sampled_scene(std::uint32_t samples, std::uint32_t size = side) {
    FunctionalScene scene(size, size);
    scene.view.samples = samples;
    return scene;
}

/// Row and column of a pixel, and how many fragments each of its samples got.
using Counts = std::vector<std::vector<std::uint32_t>>;

Counts counts_of_samples(const FragmentStream& stream) {
    Counts counts(std::size_t{stream.width} * stream.height, std::vector<std::uint32_t>(stream.samples));
    for (const Quad& quad : stream.quads)
        for (std::uint32_t lane = 0; lane < 4; ++lane) {
            if ((quad.covered >> lane & 1) == 0) continue;
            const std::uint32_t row =
                quad.y + lane / 2 - quad.sample * pipeline::plane_rows(stream.height, stream.samples);
            ++counts.at(row * stream.width + quad.x + lane % 2).at(quad.sample);
        }
    return counts;
}

std::uint32_t covered_samples(const std::vector<std::uint32_t>& pixel) {
    std::uint32_t sum = 0;
    for (const std::uint32_t sample : pixel) sum += sample;
    return sum;
}

/// The part of a pixel, whose top left corner this is, right of the line through `on` with the normal `n`.
double share_beyond(glm::dvec2 corner, glm::dvec2 on, glm::dvec2 n) {
    const std::array<glm::dvec2, 4> square{corner, corner + glm::dvec2(1, 0), corner + glm::dvec2(1, 1),
                                           corner + glm::dvec2(0, 1)};
    double twice = 0;
    std::vector<glm::dvec2> kept;
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec2 a = square[i], b = square[(i + 1) % 4];
        const double da = glm::dot(a - on, n), db = glm::dot(b - on, n);
        if (da >= 0) kept.push_back(a);
        if ((da >= 0) != (db >= 0)) kept.push_back(a + (b - a) * (da / (da - db)));
    }
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const glm::dvec2 a = kept[i], b = kept[(i + 1) % kept.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return std::fabs(twice) / 2;
}

/// A grid of cells over the whole view and beyond, each two triangles; inner corners are anywhere on the sub-pixel
/// grid.
MeshData shaken_grid(std::uint32_t size, std::uint32_t cells, std::uint64_t seed) {
    sim::Random random(seed, "grid");
    const double step = static_cast<double>(size) / cells;
    std::vector<glm::vec3> corners;
    for (std::uint32_t row = 0; row <= cells; ++row)
        for (std::uint32_t column = 0; column <= cells; ++column) {
            const bool rim = row == 0 || column == 0 || row == cells || column == cells;
            const auto at = [&](std::uint32_t line) {
                const double shake = rim ? 0.0 : 0.4 * (random.uniform() - 0.5); // turns no triangle over
                return static_cast<float>(std::floor((line + shake) * step * 256.0) / 256.0);
            };
            const float x = at(column), y = at(row);
            corners.emplace_back(x, y, static_cast<float>(random.uniform()));
        }
    MeshData mesh;
    for (std::uint32_t row = 0; row < cells; ++row)
        for (std::uint32_t column = 0; column < cells; ++column) {
            const std::uint32_t a = row * (cells + 1) + column, b = a + 1, c = a + cells + 1, d = c + 1;
            for (const std::uint32_t corner : {a, b, c, b, d, c}) mesh.positions.push_back(corners[corner]);
        }
    return mesh;
}

} // namespace

TEST(Samples, EverySampleHasARowAndAColumnOfItsOwnAroundTheCentre) {
    EXPECT_EQ(pipeline::sample_pattern(1)[0].x, 0);
    EXPECT_EQ(pipeline::sample_pattern(1)[0].y, 0);
    for (const std::uint32_t samples : {4U, 8U}) {
        std::set<std::int32_t> columns, rows;
        SampleOffset sum;
        for (const SampleOffset& offset : pipeline::sample_pattern(samples)) {
            EXPECT_LT(std::abs(offset.x), 128);
            EXPECT_LT(std::abs(offset.y), 128);
            columns.insert(offset.x);
            rows.insert(offset.y);
            sum = {sum.x + offset.x, sum.y + offset.y};
        }
        EXPECT_EQ(columns.size(), samples);
        EXPECT_EQ(rows.size(), samples);
        EXPECT_EQ(sum.x, 0);
        EXPECT_EQ(sum.y, 0);
    }
}

TEST(Samples, AnUprightEdgeCoversThoseAtItAndRightOfIt) {
    for (const std::uint32_t samples : {4U, 8U})
        for (int step = 0; step <= 32; ++step) {
            const float edge = 3.0F + static_cast<float>(step) / 32.0F;
            FunctionalScene scene = sampled_scene(samples);
            scene.add(tests::rectangle(edge, 0, side, side));
            const Counts counts = counts_of_samples(scene.rasterize());
            for (std::uint32_t sample = 0; sample < samples; ++sample) {
                const SampleOffset at = pipeline::sample_pattern(samples)[sample];
                const float column = 3.5F + static_cast<float>(at.x) / 256.0F;
                for (std::uint32_t row = 0; row < side; ++row)
                    EXPECT_EQ(counts[row * side + 3][sample], column >= edge ? 1U : 0U) << edge << " " << sample;
            }
        }
}

TEST(Samples, EightSamplesOfASlantedEdgeAreNearItsArea) {
    double worst = 0;
    for (int degrees = 3; degrees < 360; degrees += 13) {
        const double angle = degrees * 3.14159265358979 / 180.0;
        const glm::dvec2 n(std::cos(angle), std::sin(angle)), along(-n.y, n.x), on(16.3, 15.8);
        const glm::dvec2 a = on - along * 200.0, b = on + along * 200.0, c = on + n * 300.0;
        FunctionalScene scene = sampled_scene(8);
        MeshData mesh;
        for (const glm::dvec2& corner : {a, b, c}) mesh.positions.emplace_back(corner.x, corner.y, 0.5);
        scene.add(mesh);
        const Counts counts = counts_of_samples(scene.rasterize());
        double sum = 0;
        std::uint32_t cut = 0;
        for (std::uint32_t pixel = 0; pixel < side * side; ++pixel) {
            const double share = share_beyond({pixel % side, pixel / side}, on, n);
            const double error = std::fabs(covered_samples(counts[pixel]) / 8.0 - share);
            if (share == 0.0 || share == 1.0) {
                EXPECT_LT(error, 0.01);
                continue;
            }
            worst = std::max(worst, error);
            sum += error;
            ++cut;
        }
        ASSERT_GT(cut, side / 2);
        EXPECT_LT(sum / cut, 1.0 / 8) << degrees;
    }
    EXPECT_LT(worst, 0.25); // of every edge through a pixel: 0.226, at 124 degrees
    EXPECT_GT(worst, 0.0);
}

TEST(Samples, NeighboursCoverEverySampleExactlyOnce) {
    for (const std::uint32_t samples : {4U, 8U})
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            FunctionalScene scene = sampled_scene(samples);
            scene.add(shaken_grid(side, 9, seed));
            for (const auto& pixel : counts_of_samples(scene.rasterize()))
                for (const std::uint32_t fragments : pixel) ASSERT_EQ(fragments, 1U) << samples << " " << seed;
        }
}

TEST(Samples, APlaneIsTheViewThroughItsSample) {
    // All numbers are multiples of 1/256 in a view of a power of two: moving the view is exact.
    for (const std::uint32_t samples : {4U, 8U}) {
        FunctionalScene scene = sampled_scene(samples);
        MeshData mesh = shaken_grid(side, 9, 7);
        for (glm::vec3& corner : mesh.positions) corner.z = std::floor(corner.z * 256.0F) / 256.0F;
        scene.add(mesh);
        const FragmentStream all = scene.rasterize();
        const std::uint32_t plane = pipeline::plane_rows(side, samples);
        for (std::uint32_t sample = 0; sample < samples; ++sample) {
            FunctionalScene moved = scene;
            moved.view = pipeline::view_of_sample(scene.view, sample);
            const FragmentStream one = moved.rasterize();
            std::size_t next = 0;
            for (std::size_t id = 0; id < all.quads.size(); ++id) {
                const Quad& quad = all.quads[id];
                if (quad.sample != sample) continue;
                ASSERT_LT(next, one.quads.size());
                const Quad& same = one.quads[next];
                EXPECT_EQ(quad.x, same.x);
                EXPECT_EQ(quad.y - sample * plane, same.y);
                EXPECT_EQ(quad.covered, same.covered);
                EXPECT_EQ(quad.triangle, same.triangle);
                for (std::size_t lane = 0; lane < 4; ++lane)
                    EXPECT_NEAR(all.depths[id][lane], one.depths[next][lane], 1e-6);
                ++next;
            }
            EXPECT_EQ(next, one.quads.size());
        }
    }
}

TEST(Samples, AGroupIsOneQuadOfPixelsWithOneColour) {
    FunctionalScene scene = sampled_scene(8);
    MeshData mesh = shaken_grid(side, 9, 3);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.colours.emplace_back(i % 3 == 0 ? 1.0F : 0.0F, i % 3 == 1 ? 1.0F : 0.0F, i % 3 == 2 ? 1.0F : 0.0F, 1.0F);
    scene.add(mesh);
    const FragmentStream stream = scene.rasterize();
    const std::uint32_t plane = pipeline::plane_rows(side, 8);
    std::uint64_t groups = 0;
    for (std::size_t first = 0; first < stream.quads.size(); ++groups) {
        const std::size_t end = first + stream.quads[first].more + 1;
        for (std::size_t id = first; id < end; ++id) {
            EXPECT_EQ(stream.quads[id].more, end - id - 1);
            EXPECT_EQ(stream.quads[id].x, stream.quads[first].x);
            EXPECT_EQ(stream.quads[id].y % plane, stream.quads[first].y % plane);
            EXPECT_EQ(stream.quads[id].y / plane, stream.quads[id].sample);
            EXPECT_EQ(stream.quads[id].triangle, stream.quads[first].triangle);
            EXPECT_NE(stream.quads[id].covered, 0);
            EXPECT_EQ(stream.colours[id], stream.colours[first]);
            if (id > first) {
                EXPECT_GT(stream.quads[id].sample, stream.quads[id - 1].sample);
            }
            // Shaded where the triangle is: three shares of one whole.
            for (std::uint32_t lane = 0; lane < 4; ++lane) {
                if ((stream.quads[id].alive >> lane & 1) == 0) continue;
                const glm::vec4& colour = stream.colours[id][lane];
                EXPECT_GE(std::min({colour.r, colour.g, colour.b}), 0.0F);
                EXPECT_NEAR(colour.r + colour.g + colour.b, 1.0F, 1e-5F);
            }
        }
        first = end;
    }
    EXPECT_EQ(groups, stream.groups);
    EXPECT_LT(groups, stream.quads.size());
}

TEST(Samples, AreTheSameForAnyNumberOfThreads) {
    FunctionalScene scene = sampled_scene(8, 128);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        MeshData mesh = shaken_grid(128, 11, seed);
        mesh.colours.assign(mesh.positions.size(), glm::vec4(0.25F, 0.5F, 1.0F, 0.5F));
        scene.add(mesh);
    }
    const auto on_threads = [&scene](unsigned threads) {
        pipeline::FrontEndOptions options;
        options.threads = threads;
        return scene.rasterize(options);
    };
    const FragmentStream one = on_threads(1);
    ASSERT_GT(one.quads.size(), 3U * 8192); // groups lie across the ends of the pieces of work
    EXPECT_TRUE(tests::equal(one, on_threads(2)));
    EXPECT_TRUE(tests::equal(one, on_threads(5)));
}

TEST(Samples, OtherNumbersAndTooLargePicturesAreRefused) {
    for (const std::uint32_t samples : {0U, 2U, 3U, 16U}) {
        FunctionalScene scene = sampled_scene(samples);
        EXPECT_THROW(scene.rasterize(), sim::InputError) << samples;
    }
    const auto fits = [](std::uint32_t width, std::uint32_t height, std::uint32_t samples) {
        FunctionalScene scene(width, height);
        scene.view.samples = samples;
        try {
            scene.rasterize();
        } catch (const sim::InputError&) {
            return false;
        }
        return true;
    };
    EXPECT_TRUE(fits(1, 16384, 4)); // the last row is number 65535
    EXPECT_TRUE(fits(1, 8192, 8));
    EXPECT_FALSE(fits(1, 8193, 8));
    EXPECT_TRUE(fits(16384, 4096, 4));
    EXPECT_FALSE(fits(16384, 4112, 4));
}

TEST(Samples, OfAPixelLieInOnePartitionAndInTilesOfTheirOwn) {
    for (const std::uint32_t partitions : {1U, 2U, 3U, 4U, 6U, 8U})
        for (const std::uint32_t height : {1U, 18U, 40U}) {
            const pipeline::SurfaceLayout one{24, height, partitions}, eight{24, height, partitions, 8};
            std::set<std::uint32_t> tiles;
            for (std::uint32_t y = 0; y < height; ++y)
                for (std::uint32_t x = 0; x < 24; ++x)
                    for (std::uint32_t sample = 0; sample < 8; ++sample) {
                        const std::uint32_t row = y + sample * eight.rows_of_plane();
                        EXPECT_EQ(eight.partition_of(x, row), one.partition_of(x, y));
                        EXPECT_EQ(eight.pixel_row(row), y);
                        EXPECT_TRUE(eight.inside(x, row));
                        tiles.insert(eight.tile_of(x, row));
                    }
            EXPECT_EQ(tiles.size(), std::size_t{8} * one.tiles());
            EXPECT_LT(*tiles.rbegin(), eight.tiles());
            EXPECT_EQ(eight.inside(0, height), eight.rows_of_plane() == height);
        }
}

TEST(Samples, MeanOfOneValueIsThatValue) {
    pipeline::View view;
    view.width = 3;
    view.height = 5;
    for (const std::uint32_t samples : {1U, 4U, 8U}) {
        view.samples = samples;
        for (const float value : {0.1F, 1.0F / 3.0F, 1e-30F, 65504.0F}) {
            const std::vector<float> planes(view.places() * 4, value);
            EXPECT_EQ(pipeline::mean_of_samples(view, planes, 4), std::vector<float>(15 * 4, value));
        }
    }
    view.samples = 4;
    std::vector<float> planes(view.places());
    for (std::size_t at = 0; at < planes.size(); ++at)
        planes[at] = static_cast<float>(at / (std::size_t{3} * pipeline::plane_rows(5, 4)));
    EXPECT_EQ(pipeline::mean_of_samples(view, planes, 1), std::vector<float>(15, 1.5F)); // of 0, 1, 2 and 3
}
