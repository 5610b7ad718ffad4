// A design made outside of the library, through its public headers alone: the worked example of
// models/kbuffers/README.md.
#include "models/kbuffers/configured_design.hpp"
#include "tests/support/replay.hpp"

#include <gtest/gtest.h>

namespace design_from_outside_test {

struct SerialParams {
    std::uint32_t triangles = 1;

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&SerialParams::triangles>("Triangles between two flushes").unit("triangles").range(1, 65536)};
    }
};
static_assert(sim::fully_described<SerialParams>);

class Serial final : public models::ConfiguredDesign<Serial, SerialParams> {
  public:
    static constexpr std::string_view name = "serial";
    static constexpr std::string_view text = "unprotected hardware with a flush after every few triangles";

    using ConfiguredDesign::ConfiguredDesign;

    pipeline::KBufferPlan plan(const pipeline::ModifyProgram&, const pipeline::View&) const override {
        pipeline::KBufferPlan plan;
        plan.site = pipeline::UpdateSite::fragment_shader;
        plan.shader.flush.every_triangles = params_.triangles;
        return plan;
    }
};

pipeline::RunResult run(const support::Replay& replay, const std::vector<std::string>& settings) {
    sim::Config config;
    for (const std::string& setting : settings) config.set(setting);
    const models::DesignInfo info = Serial::info();
    EXPECT_EQ(info.id, "serial");
    EXPECT_EQ(info.parameters().size(), 1U);
    const auto design = info.make(config);
    config.expect_all_used();
    return pipeline::Machine({}, replay.frame, replay.streams, *design).run(replay.reference);
}

TEST(DesignFromOutside, RunsLikeThoseOfTheLibrary) {
    const support::Replay replay("gen:blob?triangles=600", {.width = 32, .height = 32});
    const pipeline::RunResult protect = run(replay, {});
    EXPECT_EQ(protect.design, "serial");
    EXPECT_EQ(protect.hazards.total(), 0U);
    EXPECT_EQ(protect.wrong_pixels, 0U);
    const pipeline::RunResult rarely = run(replay, {"serial.triangles=300"});
    EXPECT_GT(rarely.hazards.total(), 0U);
    EXPECT_LT(rarely.cycles, protect.cycles);
    EXPECT_THROW(run(replay, {"serial.triangles=0"}), sim::InputError);
}

} // namespace design_from_outside_test
