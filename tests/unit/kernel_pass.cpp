// Kernels: groups that read surfaces and store texels, each of which has one writer.
#include "pipeline/functional/compose_pass.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/functional/surface_values.hpp"
#include "sim/check.hpp"
#include "traces/pass_graph.hpp"

#include <array>
#include <functional>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <vector>

namespace kernel_pass_test {

using pipeline::KernelStores;
using pipeline::SurfaceAccess;
using pipeline::SurfaceFormat;
using pipeline::SurfaceInfo;
using pipeline::SurfaceStore;

constexpr std::uint32_t width = 40, height = 50;

class FunctionKernel final : public pipeline::Kernel {
  public:
    using Run = std::function<void(const glm::uvec2&, SurfaceAccess&, KernelStores&)>;

    FunctionKernel(const pipeline::KernelShape& shape, Run run) : shape_(shape), run_(std::move(run)) {}
    pipeline::KernelShape shape() const override { return shape_; }
    void run(const glm::uvec2& group, SurfaceAccess& surfaces, KernelStores& stores) const override {
        run_(group, surfaces, stores);
    }

  private:
    pipeline::KernelShape shape_;
    Run run_;
};

/// Surface 0 counts its texels; surface 1 has two planes, surface 2 is small. Both are full of sevens and cleared to 1.
SurfaceStore surfaces() {
    SurfaceInfo source{.name = "source", .format = SurfaceFormat::r32f, .width = width, .height = height};
    SurfaceInfo large{.name = "large", .format = SurfaceFormat::rgba32f, .width = width, .height = height, .planes = 2};
    SurfaceInfo small{.name = "small", .format = SurfaceFormat::r32f, .width = 4, .height = 4};
    pack_colour(large.format, glm::vec4(1.0F), large.cleared.data());
    pack_colour(small.format, glm::vec4(1.0F), small.cleared.data());
    SurfaceStore store(std::array{source, large, small});
    float next = 0.0F;
    for (pipeline::SurfaceId surface = 0; surface < 3; ++surface)
        for (std::uint32_t row = 0; row < store.rows(surface); ++row)
            for (std::uint32_t x = 0; x < store.info(surface).width; ++x)
                pack_colour(store.info(surface).format, glm::vec4(surface == 0 ? next++ : 7.0F),
                            store.written(surface, {x, row, 0}));
    return store;
}

pipeline::Pass pass_of(const pipeline::KernelShape& shape, FunctionKernel::Run run,
                       std::vector<pipeline::SurfaceId> targets = {1, 2}) {
    pipeline::Pass pass;
    pass.name = "count";
    pass.kind = pipeline::PassKind::compose;
    pass.kernel = std::make_shared<FunctionKernel>(shape, std::move(run));
    pass.reads = {0};
    pass.targets = std::move(targets);
    return pass;
}

/// A group is a row, which it copies into plane 1 of the first target from right to left; groups of the second column
/// store what they have copied together.
const pipeline::KernelShape copying{.targets = 2, .reads = 1, .groups = {2, height}};
void copy(const glm::uvec2& group, SurfaceAccess& access, KernelStores& stores) {
    float sum = 0.0F;
    const auto y = static_cast<std::int32_t>(group.y);
    for (std::uint32_t x = 0; x < width; ++x) {
        const auto texels = access.fetch(0, {static_cast<std::int32_t>(x)}, {y}, 1);
        if (group.x == 0) stores.store(0, width - 1 - x, group.y, 1, glm::vec4(texels[0].r));
        sum += texels[0].r;
    }
    if (group.x == 1 && group.y < 4) stores.store(1, group.y, 3, 0, glm::vec4(sum));
}

std::string refusal(const pipeline::Pass& pass, unsigned threads = 1) {
    SurfaceStore store = surfaces();
    try {
        compose(pass, store, threads);
    } catch (const sim::InternalError& error) {
        return error.what();
    }
    return "";
}

TEST(KernelPass, TargetsAreMadeAnewOfWhatItsGroupsStore) {
    SurfaceStore store = surfaces();
    compose(pass_of(copying, copy), store, 1);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::uint32_t second = pipeline::plane_rows(height, 2) + y;
            const auto at = [&](std::uint32_t row) {
                return *reinterpret_cast<const float*>(store.read(1, {x, row, 0}));
            };
            ASSERT_EQ(at(y), 1.0F); // nobody stored to the first plane, so it is cleared
            ASSERT_EQ(at(second), static_cast<float>(y * width + (width - 1 - x)));
        }
    const std::vector<float> small = channel_of(store, 2, 0);
    for (std::uint32_t i = 0; i < 16; ++i) { // 0 + 1 + ... of row y is 40 * 40 * y + 780
        const auto sum = static_cast<float>(width * width * (i % 4) + 780);
        EXPECT_EQ(small[i], i / 4 == 3 ? sum : 1.0F) << i;
    }
}

TEST(KernelPass, AnyNumberOfThreadsGivesTheSameBytes) {
    SurfaceStore one = surfaces();
    compose(pass_of(copying, copy), one, 1);
    for (const unsigned threads : {2U, 5U, 0U}) {
        SurfaceStore many = surfaces();
        compose(pass_of(copying, copy), many, threads);
        for (const pipeline::SurfaceId target : {1U, 2U}) {
            EXPECT_EQ(many.digest(target), one.digest(target)) << threads;
            EXPECT_EQ(many.memory(target).allocated, one.memory(target).allocated);
        }
    }
}

TEST(KernelPass, TwoWritersOfATexelAreRefusedWithBothNames) {
    const auto clash = [](const glm::uvec2& group, SurfaceAccess&, KernelStores& stores) {
        stores.store(0, group.x, group.y == 40 ? 3 : group.y, 1, glm::vec4(0.5F)); // row 40 stores to row 3
    };
    const pipeline::Pass pass = pass_of({.targets = 2, .reads = 1, .groups = {2, 50}}, clash);
    for (const unsigned threads : {1U, 4U}) {
        EXPECT_NE(refusal(pass, threads)
                      .find("pass count: group (0, 3) and group (0, 40) both store texel (0, 3, 1) of large"),
                  std::string::npos)
            << refusal(pass, threads);
    }
    const auto twice = [](const glm::uvec2&, SurfaceAccess&, KernelStores& stores) {
        for (int i = 0; i < 2; ++i) stores.store(1, 0, 0, 0, glm::vec4(0.5F));
    };
    EXPECT_NE(refusal(pass_of({.targets = 2, .reads = 1}, twice)).find("group (0, 0) and group (0, 0)"),
              std::string::npos);
}

TEST(KernelPass, OnlyTexelsThatItsTargetsHaveCanBeStored) {
    using Store = KernelStores::Store;
    for (const Store& one : {Store{.target = 1, .x = 4}, Store{.target = 1, .y = 4}, Store{.target = 0, .plane = 2}}) {
        const auto beside = [one](const glm::uvec2&, SurfaceAccess&, KernelStores& stores) {
            stores.store(one.target, one.x, one.y, one.plane, one.value);
        };
        EXPECT_NE(refusal(pass_of({.targets = 2, .reads = 1}, beside)).find("which it does not have"),
                  std::string::npos);
    }
    const auto unknown = [](const glm::uvec2&, SurfaceAccess&, KernelStores& stores) {
        stores.store(2, 0, 0, 0, glm::vec4(0.0F));
    };
    EXPECT_NE(refusal(pass_of({.targets = 2, .reads = 1}, unknown)).find("target 2"), std::string::npos);
}

TEST(KernelPass, WhatNobodyReadsIsNotKept) {
    SurfaceStore store = surfaces();
    compose(pass_of(copying, copy, {pipeline::no_surface, 2}), store, 1);
    EXPECT_EQ(channel_of(store, 1, 0), std::vector<float>(store.places(1), 7.0F)); // as it was
    EXPECT_EQ(channel_of(store, 2, 0)[12], 780.0F);
}

TEST(KernelPass, ItsOwnTargetCannotBeRead) {
    EXPECT_NE(refusal(pass_of(copying, copy, {1, 0})).find("pass count: it reads its target source"),
              std::string::npos);
    pipeline::Frame frame;
    frame.resources = std::make_shared<pipeline::Resources>();
    traces::PassGraph graph(frame);
    EXPECT_THROW(
        graph.add_kernel("count", std::make_shared<FunctionKernel>(copying, copy), {"large"}, {"small", "large"}),
        sim::InputError);
}

TEST(KernelPass, KnowsAsManySurfacesAsItSays) {
    pipeline::Pass pass = pass_of(copying, copy);
    pass.reads = {};
    EXPECT_NE(refusal(pass).find("its kernel knows 2 and 1"), std::string::npos);
    EXPECT_NE(refusal(pass_of({.targets = 1, .reads = 1}, copy)).find("its kernel knows 1 and 1"), std::string::npos);
}

} // namespace kernel_pass_test
