#include "tests/support/sample_comparison.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace ropsim_test {

using pipeline::HazardClass;
using pipeline::HazardKind;
using pipeline::RunResult;
using Json = nlohmann::ordered_json;

namespace {

constexpr std::uint32_t width = 8, height = 4, layers = 2;

class TwoNearest final : public pipeline::ModifyProgram {
  public:
    explicit TwoNearest(bool colours) : ModifyProgram(layers, colours ? 4 : 1), colours_(colours) {}
    std::string_view id() const override { return "two_nearest"; }
    std::string_view summary() const override { return "keeps the two nearest"; }
    pipeline::ProgramCost cost() const override { return {8}; }
    pipeline::OrderNeed order_need() const override { return pipeline::OrderNeed::any; }
    bool needs_texture() const override { return false; }
    bool needs_colour() const override { return colours_; }
    std::uint32_t depth_slot() const override { return floats_per_entry() - 1; }
    void clear(float* pixel) const override {
        std::fill_n(pixel, floats_per_pixel(), 0.0F);
        for (std::uint32_t layer = 0; layer < layers; ++layer) pixel[layer * floats_per_entry() + depth_slot()] = 1.0F;
    }
    bool insert(float*, const float*) const override { return false; }
    void make_entry(const pipeline::Fragment&, float*) const override {}

  private:
    bool colours_;
};

std::uint32_t fragments_at(std::uint32_t x) { return x == 0 || x == 7 ? 0 : x >= 2 && x <= 5 ? 2 : 1; }

// Layer 0 is red at depth 0.4, layer 1 blue at 0.6; half of each shows through.
void fill_pixel(const pipeline::ModifyProgram& program, float* pixel, float* rgba, std::uint32_t fragments) {
    program.clear(pixel);
    for (std::uint32_t layer = 0; layer < fragments; ++layer) {
        float* entry = pixel + layer * program.floats_per_entry();
        entry[program.depth_slot()] = layer == 0 ? 0.4F : 0.6F;
        if (program.needs_colour()) {
            entry[0] = layer == 0 ? 1.0F : 0.0F;
            entry[2] = layer == 0 ? 0.0F : 1.0F;
        }
    }
    const float red = fragments > 0 ? 0.5F : 0.0F, blue = fragments > 1 ? 0.25F : 0.0F;
    const float rest = 1.0F - red - blue;
    const std::array<float, 4> colour{red + rest, rest, blue + rest, 1.0F};
    std::copy(colour.begin(), colour.end(), rgba);
}

reports::FramePixels correct_pixels(const pipeline::ModifyProgram& program) {
    reports::FramePixels pixels;
    pixels.kbuffer.resize(std::size_t{width} * height * program.floats_per_pixel());
    pixels.composite.resize(std::size_t{width} * height * 4);
    for (std::uint32_t i = 0; i < width * height; ++i)
        fill_pixel(program, &pixels.kbuffer[std::size_t{i} * program.floats_per_pixel()], &pixels.composite[i * 4UL],
                   fragments_at(i % width));
    return pixels;
}

RunResult common_run(const std::string& design) {
    RunResult run;
    run.design = design;
    run.core_mhz = 650;
    run.cycles = 6500;
    run.fragments = 40;
    run.built = {"index_fetch", "rasterizer"};
    run.left_out = {{"stencil", "no pass tests it"}};
    run.host_seconds = 0.01;
    run.host_ticks = 12345;
    run.layers.resize(layers);
    *run.stages = {{"rasterizer",
                    {{"params", {{"quads_per_clock", 4}}},
                     {"counters",
                      {{"quads", 10},
                       {"occupancy",
                        {{"count", 2},
                         {"sum", 6},
                         {"min", 1},
                         {"max", 5},
                         {"mean", 3.0},
                         {"bin_width", 0},
                         {"bins", {{"1", 1}, {"4", 1}}}}}}},
                     {"activity", {{"busy", 6000}, {"idle", 500}}}}}};
    *run.stalls = {{"rasterizer", {{"idle", 0.1}, {"busy", 0.7}, {"memory", 0.2}}}};
    *run.caches = {{"texture_l1", {{"accesses", 10}, {"hits", 8}, {"misses", 2}, {"hit_rate", 0.8}}}};
    *run.bytes = {{"dram", {{"bytes", 5120}, {"per_fragment", 128.0}}}};
    *run.area = {{"tile_cache_bytes", 65536},
                 {"payload_bytes", 4096},
                 {"added_bytes", 8},
                 {"total_bytes", 69640},
                 {"tile_caches", {{"depth", 0}, {"colour", 0}, {"kbuffer", 65536}}},
                 {"added", {{"scoreboard", 8}}},
                 {"added_comparators", 0},
                 {"added_alu_lanes", 0}};
    run.passes.push_back({"layers, all", 5, 6000, Json({{"rasterizer", {{"quads", 10}}}})});
    run.draw_counters = {"quads"};
    run.draws.push_back({"draw \"a\"", 0, {10}});
    return run;
}

RunResult racy_run() {
    RunResult run = common_run("racy");
    run.hazards.at(HazardClass::h1_in_flight, HazardKind::concurrency) = 1;
    run.hazards.at(HazardClass::h3_stale_line, HazardKind::incoherence) = 1;
    run.hazards.pixels = 2;
    run.hazard_distance = {0, 1, 0, 1};
    run.pairs = {{2, 1, HazardClass::h1_in_flight, HazardKind::concurrency, 7, 3, 1, 100, 140},
                 {5, 2, HazardClass::h3_stale_line, HazardKind::incoherence, 9, 4, 2, 120, 110}};
    run.max_staleness = 2;
    run.mean_staleness = 1.5;
    run.lost_updates = run.wrong_pixels = run.wrong_because.hazard = run.lost_fragments = 2;
    run.layers[1].missing = 2;
    run.hazard_mask.resize(std::size_t{width} * height);
    run.wrong_mask.resize(std::size_t{width} * height);
    run.hazard_mask[1 * width + 2] = 1;
    run.hazard_mask[2 * width + 5] = 4;
    run.wrong_mask[1 * width + 2] = run.wrong_mask[2 * width + 5] = 1;
    return run;
}

reports::Comparison make(bool colours) {
    reports::Comparison comparison;
    auto program = std::make_shared<TwoNearest>(colours);
    auto frame = std::make_shared<pipeline::Frame>();
    frame->workload = "transparency";
    frame->program = program;
    frame->view.width = width;
    frame->view.height = height;
    comparison.frame = frame;
    comparison.scene = {"two <sheets>.glb", "0123456789abcdef", 4, 4, 8, 2, 0, "auto", "", {"1 line primitive"}, {}};
    comparison.gpu = {"neutral", Json({{"rop", {{"units", 16}}}}), {{"rop.units", {"public", "data sheet", ""}}}};
    comparison.reference = correct_pixels(*program);
    for (std::uint32_t i = 0; i < width * height; ++i) comparison.depth_complexity.push_back(fragments_at(i % width));
    RunResult racy = racy_run(), safe = common_run("safe");
    safe.built.emplace_back("scoreboard");
    safe.cycles = 13000;
    comparison.pixels.assign(2, comparison.reference);
    for (const std::size_t pixel : {1UL * width + 2, 2UL * width + 5})
        fill_pixel(*program, &comparison.pixels[0].kbuffer[pixel * program->floats_per_pixel()],
                   &comparison.pixels[0].composite[pixel * 4], 1);
    racy.kbuffer = comparison.pixels[0].kbuffer;
    safe.kbuffer = comparison.pixels[1].kbuffer;
    comparison.runs = {std::move(racy), std::move(safe)};
    comparison.variants = {{"racy", "racy?bypass_l1=false", "racy bypass_l1=false"}, {"safe", "safe", "safe"}};
    comparison.design_support.assign(
        2, Json({{"programs", {"nearest-k rgbz"}}, {"antialiasing", "supersampling"}, {"early_reject", false}}));
    comparison.design_parameters = {Json({{"bypass_l1", false}}), Json({{"entries", 64}})};
    comparison.host = {1.5, 0.25, 100'000'000, 2};
    return comparison;
}

} // namespace

reports::Comparison sample_comparison() { return make(true); }

reports::Comparison sample_depth_comparison() { return make(false); }

} // namespace ropsim_test
