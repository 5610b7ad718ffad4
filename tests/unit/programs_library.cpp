// Programs by name.
#include "models/kbuffers/library.hpp"
#include "models/programs/library.hpp"
#include "sim/check.hpp"
#include "sim/config.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace programs_library_test {

std::string error_of(std::string_view id, std::string_view entry, std::uint32_t k) {
    try {
        models::make_program(id, entry, k);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return {};
}

TEST(ProgramLibrary, MakesEveryProgramItListsUpToItsLargestK) {
    EXPECT_EQ(models::programs().size(), 8U);
    for (const models::Program& program : models::programs())
        for (const std::string& entry : program.entries)
            for (const std::uint32_t k : {1U, program.most_k}) {
                const auto made = models::make_program(program.id, entry, k);
                EXPECT_EQ(made->id(), program.id);
                EXPECT_EQ(made->k(), k);
                EXPECT_LE(made->targets(), pipeline::most_targets);
                EXPECT_LE(made->floats_per_entry(), pipeline::largest_entry);
                EXPECT_LT(made->depth_slot(), made->floats_per_entry());
                EXPECT_GT(made->cost().operations, 0U);
            }
}

TEST(ProgramLibrary, ErrorsNameWhatWasExpected) {
    EXPECT_EQ(error_of("nearest_k", "z", 4),
              "program: expected one of nearest-k, order-and-blend, mlab, depth-partition, isosurface, volume, "
              "z-buffer, stencil, got 'nearest_k'; did you mean 'nearest-k'?");
    EXPECT_EQ(error_of("nearest-k", "rgbx", 4),
              "program nearest-k: entry: expected one of rgbz, z, zo, zor, got 'rgbx'; did you mean 'rgbz'?");
    EXPECT_EQ(error_of("nearest-k", "z", 0), "program nearest-k: k: expected 1 to 64, got 0");
    EXPECT_EQ(error_of("order-and-blend", "rgbz", 64), "program order-and-blend: k: expected 1 to 63, got 64");
    EXPECT_EQ(error_of("z-buffer", "rgbz", 4), "program z-buffer: k: expected 1, got 4");
    EXPECT_EQ(error_of("nearest_k.kb", "z", 4),
              "program nearest_k.kb: it declares its entries; expected no kind, got 'z'");
}

TEST(ProgramLibrary, DesignsRefuseWhatTheyCannotRun) {
    sim::Config config;
    const auto refusals = [&](std::string_view program) {
        std::vector<std::string> refused;
        const auto made = models::make_program(program, models::programs().front().id == program ? "rgbz" : "", 1);
        for (const models::DesignInfo& design : models::designs())
            if (!design.make(config)->refuses(*made).empty()) refused.emplace_back(design.id);
        return refused;
    };
    using Names = std::vector<std::string>;
    const Names peeling{"peel-rop", "multipass", "dual-peel", "atomic-min"};
    EXPECT_EQ(refusals("nearest-k"), Names{"atomic-min"}); // which takes depths alone
    EXPECT_EQ(refusals("z-buffer"), Names{"atomic-min"});
    EXPECT_EQ(refusals("depth-partition"), (Names{"peel-rop", "dual-peel", "atomic-min"}));
    EXPECT_EQ(refusals("volume"),
              (Names{"blender", "peel-rop", "multipass", "dual-peel", "cam", "hashed", "tile-ticket", "atomic-min"}));
    for (const char* program : {"order-and-blend", "mlab", "isosurface", "stencil"})
        EXPECT_EQ(refusals(program), peeling) << program;
}

} // namespace programs_library_test
