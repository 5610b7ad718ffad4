// Variants of a design: what their texts mean, and what is refused.
#include "models/kbuffers/library.hpp"
#include "pipeline/gpu_params.hpp"
#include "reports/compared_designs.hpp"
#include "reports/design_variant.hpp"
#include "sim/check.hpp"
#include "sim/described_json.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

using reports::parse_variant;
using Settings = std::vector<std::pair<std::string, std::string>>;

std::string error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return "no error";
}

std::vector<std::string> names_of(const std::vector<std::string>& texts) {
    std::vector<reports::DesignVariant> variants;
    for (const std::string& text : texts) variants.push_back(parse_variant(text));
    return reports::variant_names(variants);
}

TEST(ReportsVariants, AKeyIsTheDesignsUnlessItBeginsWithASectionOfTheGpu) {
    const auto variant = parse_variant("sorted-batched?batches.batch=4&rop.queue=128&sort_ns_per_tri=3");
    EXPECT_EQ(variant.design, "sorted-batched");
    EXPECT_EQ(variant.settings, (Settings{{"sorted-batched.batches.batch", "4"},
                                          {"rop.queue", "128"},
                                          {"sorted-batched.sort_ns_per_tri", "3"}}));
    EXPECT_EQ(parse_variant("blender?blender.lanes=2").settings, (Settings{{"blender.lanes", "2"}}));
    EXPECT_TRUE(parse_variant("existing").settings.empty());
}

TEST(ReportsVariants, NoDesignHasASectionOfTheGpu) {
    const auto& sections = sim::field_names<pipeline::GpuParams>;
    for (const models::DesignInfo& design : models::designs())
        for (const sim::FieldInfo& field : design.parameters()) {
            const std::string own = field.path.substr(design.id.size() + 1);
            if (own.find('.') == std::string::npos) continue;
            EXPECT_EQ(std::count(sections.begin(), sections.end(), own.substr(0, own.find('.'))), 0) << field.path;
        }
}

TEST(ReportsVariants, CommasInsideBracketsDoNotSplit) {
    EXPECT_EQ(reports::split_variants("a?x=[1,2],b,c?y=3", "--designs"),
              (std::vector<std::string>{"a?x=[1,2]", "b", "c?y=3"}));
    EXPECT_EQ(error_of([] { reports::split_variants("a,,b", "--designs"); }),
              "--designs: expected designs separated by commas, got 'a,,b'");
}

TEST(ReportsVariants, RowsAreNumberedWhereOneNameWouldNotTell) {
    EXPECT_EQ(names_of({"existing", "blender"}), (std::vector<std::string>{"existing", "blender"}));
    EXPECT_EQ(names_of({"existing?bypass_l1=true", "blender", "existing"}),
              (std::vector<std::string>{"existing-1", "blender", "existing-2"}));
    EXPECT_EQ(names_of({"interlock?ordered=false"}), (std::vector<std::string>{"interlock-1"}));
}

TEST(ReportsVariants, TheSameTwiceIsRefusedInAnyOrderOfItsSettings) {
    EXPECT_EQ(error_of([] {
                  names_of({"rov?lock_latency=2&rop.queue=3", "rov?rop.queue=3&lock_latency=2"});
              }),
              "--designs: 'rov?rop.queue=3&lock_latency=2' is named twice");
}

TEST(ReportsVariants, LabelsSayWhatDiffers) {
    EXPECT_EQ(parse_variant("existing?visibility=rop_cache").label(), "existing rop_cache");
    EXPECT_EQ(parse_variant("scoreboard?granularity=pixel&side_buffer=128").label(),
              "scoreboard pixel side_buffer=128");
    EXPECT_EQ(parse_variant("interlock?ordered=false&rop.queue=8").label(), "interlock ordered=false rop.queue=8");
    EXPECT_EQ(parse_variant("existing").label(), "existing");
}

TEST(ReportsVariants, FramesAndOtherDesignsAreNotTheirs) {
    for (const char* text : {"blender?scene=a", "blender?workload.k=3"})
        EXPECT_NE(error_of([&] { parse_variant(text); }).find("is of the frame"), std::string::npos) << text;
    EXPECT_NE(error_of([] { parse_variant("blender?scoreboard.wakes=3"); }).find("is of another design"),
              std::string::npos);
    EXPECT_NE(error_of([] { parse_variant("blender?lanes"); }).find("expected DESIGN?KEY=VALUE"), std::string::npos);
    EXPECT_NE(error_of([] { parse_variant("blender?lanes=1&lanes=2"); }).find("set twice"), std::string::npos);
}

reports::Hardware hardware_of(const std::vector<std::string>& designs, const std::vector<std::string>& settings) {
    reports::ComparisonRequest request;
    request.designs = designs;
    request.gpu_settings = settings;
    return reports::read_hardware(request);
}

TEST(ReportsVariants, AVariantWinsOverTheSettingsOfTheComparison) {
    const auto hardware = hardware_of({"blender?rop.queue=7&lanes=2", "blender"}, {"rop.queue=9", "blender.lanes=3"});
    ASSERT_EQ(hardware.designs.size(), 2U);
    EXPECT_EQ(hardware.designs[0].gpu.rop.queue, 7U);
    EXPECT_EQ(sim::to_json(hardware.designs[0].design->parameters()).at("lanes"), 2);
    EXPECT_EQ(*hardware.designs[0].gpu_changes, nlohmann::ordered_json({{"rop.queue", 7}}));
    EXPECT_EQ(hardware.designs[1].gpu.rop.queue, 9U);
    EXPECT_EQ(sim::to_json(hardware.designs[1].design->parameters()).at("lanes"), 3);
    EXPECT_TRUE(hardware.designs[1].gpu_changes->empty());
    EXPECT_EQ(hardware.gpu.parameters->at("rop").at("queue"), 9);
}

TEST(ReportsVariants, AMisspeltKeyIsNamedWithItsVariantAndWhatIsNear) {
    EXPECT_EQ(error_of([] { hardware_of({"existing?visibilty=x"}, {}); }),
              "design 'existing?visibilty=x': unknown key 'existing.visibilty'; did you mean 'existing.visibility'?");
    EXPECT_NE(error_of([] { hardware_of({"blender?rop.quee=1"}, {}); }).find("did you mean 'rop.queue'?"),
              std::string::npos);
    EXPECT_NE(error_of([] { hardware_of({"blendr?lanes=1"}, {}); }).find("did you mean 'blender'?"), std::string::npos);
    EXPECT_NE(error_of([] { hardware_of({"blender?rop.queue=0"}, {}); }).find("expected whole number 1 to"),
              std::string::npos);
}

// The reference is one for all designs, and has to know.
TEST(ReportsVariants, WhatDecidesThePictureIsOfTheComparison) {
    EXPECT_NE(error_of([] {
                  hardware_of({"existing", "blender?rop.fp16_overflow=infinity"}, {});
              }).find("design 'blender?rop.fp16_overflow=infinity': 'rop.fp16_overflow' decides what the picture is"),
              std::string::npos);
    const auto hardware =
        hardware_of({"existing", "blender?rop.fp16_overflow=infinity"}, {"rop.fp16_overflow=infinity"});
    for (const auto& design : hardware.designs)
        EXPECT_EQ(design.gpu.rop.fp16_overflow, pipeline::Fp16Overflow::infinity);
}

} // namespace
