// Entries of a pixel at their limits: k, equal depths, order, overflow, thousands of layers (specification 004, section
// 6.1, items 1 to 4, 7, 8, 9, 11 and 12).
#include "models/programs/mlab.hpp"
#include "models/programs/nearest_k.hpp"
#include "models/programs/order_and_blend.hpp"
#include "models/programs/z_buffer.hpp"
#include "reports/stability/catalogue.hpp"
#include "reports/stability/floats.hpp"
#include "reports/stability/replay.hpp"
#include "reports/stability/scenes.hpp"
#include "sim/random.hpp"
#include "traces/loads.hpp"
#include "traces/workloads/csg_surface.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

namespace reports::stability::kbuffer {

using Program = std::shared_ptr<const pipeline::ModifyProgram>;

/// The pixel after these fragments; entries are as the program's make_entry() lays them out.
std::vector<float> pixel_after(const pipeline::ModifyProgram& program, const std::vector<std::vector<float>>& fragments,
                               bool drain = true) {
    std::vector<float> pixel(program.floats_per_pixel());
    program.clear(pixel.data());
    for (const auto& fragment : fragments) program.insert(pixel.data(), fragment.data());
    if (drain && program.drains()) program.drain(pixel.data());
    return pixel;
}

/// n depths 1/(n+1) ... n/(n+1), shuffled.
std::vector<float> shuffled_depths(std::uint32_t n, std::uint64_t seed) {
    sim::Random random(seed, "depths");
    std::vector<float> depths;
    for (std::uint32_t i = 1; i <= n; ++i) depths.push_back(static_cast<float>(i) / static_cast<float>(n + 1));
    for (std::size_t i = n; i > 1; --i) std::swap(depths[i - 1], depths[random.below(i)]);
    return depths;
}

/// n fragments into k entries of depths, twenty orders of arrival: the k smallest, sorted, then empty ones.
void nearest(Finding& finding, std::uint32_t k, std::uint32_t n) {
    const Program program = models::make_nearest_k(models::EntryKind::z, k);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        std::vector<float> depths = shuffled_depths(n, seed);
        std::vector<std::vector<float>> fragments;
        for (const float depth : depths) fragments.push_back({depth});
        const std::vector<float> pixel = pixel_after(*program, fragments);
        std::sort(depths.begin(), depths.end());
        depths.resize(std::max(k, n), models::empty_depth);
        for (std::uint32_t i = 0; i < k; ++i) finding.error(ulps(pixel[i], depths[i]));
    }
}

void add_overflow(std::vector<Case>& cases, std::uint32_t k) {
    const std::string id = fmt::format("kbuffer.k{}", k);
    const std::string expected = "the k smallest depths, sorted, then empty entries; the farthest are lost";
    if (k > 1)
        cases.push_back({id + "-below", Side::below, fmt::format("k = {}: k - 1 fragments, in 20 orders of arrival", k),
                         expected, "ulp", 0.0, [k](Finding& finding) { nearest(finding, k, k - 1); }});
    else
        cases.push_back({id + "-below", Side::below, "k = 1: no fragment", "the empty entry", "ulp", 0.0,
                         [](Finding& finding) { nearest(finding, 1, 0); }});
    cases.push_back({id + "-at", Side::at, fmt::format("k = {}: k fragments, in 20 orders of arrival", k), expected,
                     "ulp", 0.0, [k](Finding& finding) { nearest(finding, k, k); }});
    cases.push_back({id + "-above", Side::above, fmt::format("k = {}: k + 1 fragments, in 20 orders of arrival", k),
                     expected, "ulp", 0.0, [k](Finding& finding) { nearest(finding, k, k + 1); }});
}

/// Fragments of equal depth, told apart by their object: those that came first stay, in their order.
void equal_depths(Finding& finding, std::uint32_t k, std::uint32_t n) {
    const Program program = models::make_nearest_k(models::EntryKind::zo, k);
    std::vector<std::vector<float>> fragments;
    for (std::uint32_t i = 0; i < n; ++i) fragments.push_back({0.5F, static_cast<float>(i)});
    const std::vector<float> pixel = pixel_after(*program, fragments);
    for (std::uint32_t i = 0; i < std::min(k, n); ++i) finding.error(static_cast<double>(pixel[i * 2 + 1]) - i);
}

void add_equal_depths(std::vector<Case>& cases) {
    cases.push_back({"kbuffer.equal-depths-below", Side::below, "3 fragments of one depth into 4 entries",
                     "all three, in the order of arrival", "places", 0.0,
                     [](Finding& finding) { equal_depths(finding, 4, 3); }});
    cases.push_back({"kbuffer.equal-depths-at", Side::at, "64 fragments of one depth into 64 entries",
                     "all 64, in the order of arrival", "places", 0.0,
                     [](Finding& finding) { equal_depths(finding, 64, 64); }});
    cases.push_back({"kbuffer.equal-depths-above", Side::above, "10,000 fragments of one depth into 4 entries",
                     "the first four", "places", 0.0, [](Finding& finding) { equal_depths(finding, 4, 10000); }});
    cases.push_back(
        {"kbuffer.nearer-behind-equals", Side::whole, "a nearer fragment displaces one of several equal depths",
         "the displaced one stays before those that came after it", "places", 0.0, [](Finding& finding) {
             const Program program = models::make_nearest_k(models::EntryKind::zo, 4);
             const auto pixel = pixel_after(*program, {{0.5F, 0}, {0.5F, 1}, {0.5F, 2}, {0.25F, 3}, {0.5F, 4}});
             const std::array<double, 4> order{3, 0, 1, 2};
             for (std::size_t i = 0; i < 4; ++i) finding.error(static_cast<double>(pixel[i * 2 + 1]) - order[i]);
         }});
    cases.push_back({"kbuffer.z-buffer-equal", Side::at, "the depth test of one entry: equal, then nearer by one float",
                     "the first of equals stays, the nearer one replaces it", "places", 0.0, [](Finding& finding) {
                         const Program program = models::make_z_buffer();
                         const auto seen = [&](float second) {
                             return static_cast<double>(pixel_after(*program, {{1, 0, 0, 0.5F}, {2, 0, 0, second}})[0]);
                         };
                         finding.error(seen(0.5F) - 1.0);
                         finding.error(seen(next_up(0.5F)) - 1.0);
                         finding.error(seen(next_down(0.5F)) - 2.0);
                     }});
}

void add_ten_thousand(std::vector<Case>& cases) {
    cases.push_back({"kbuffer.10000-layers", Side::whole, "10,000 fragments in one pixel, k = 64, shuffled",
                     "the 64 smallest depths, sorted", "ulp", 0.0, [](Finding& finding) {
                         const Program program = models::make_nearest_k(models::EntryKind::z, 64);
                         std::vector<std::vector<float>> fragments;
                         for (const float depth : shuffled_depths(10000, 3)) fragments.push_back({depth});
                         const auto pixel = pixel_after(*program, fragments);
                         for (int i = 0; i < 64; ++i)
                             finding.error(
                                 ulps(pixel[static_cast<std::size_t>(i)], static_cast<float>(i + 1) / 10001.0F));
                     }});
    cases.push_back({"kbuffer.accepted-insertions", Side::whole,
                     "16 fragments in random order, 20,000 pixels: how often a fragment is taken",
                     "k + k (H_16 - H_k): 9.19 for k = 4, 13.3 for k = 8", "relative", 0.01, [](Finding& finding) {
                         const auto harmonic = [](int n) {
                             double sum = 0;
                             for (int i = 1; i <= n; ++i) sum += 1.0 / i;
                             return sum;
                         };
                         for (const std::uint32_t k : {4U, 8U}) {
                             const Program program = models::make_nearest_k(models::EntryKind::z, k);
                             std::vector<float> pixel(program->floats_per_pixel());
                             double taken = 0;
                             for (std::uint64_t seed = 0; seed < 20000; ++seed) {
                                 program->clear(pixel.data());
                                 for (const float depth : shuffled_depths(16, seed))
                                     taken += program->insert(pixel.data(), &depth) ? 1 : 0;
                             }
                             const double expected = k + k * (harmonic(16) - harmonic(static_cast<int>(k)));
                             finding.error(taken / 20000.0 / expected - 1.0);
                         }
                     }});
    cases.push_back({"kbuffer.frame-of-10000", Side::whole,
                     "a frame of 10,000 layers over 2x2 pixels, k = 8, in three designs",
                     "no wrong pixel, no fragment lost", "pixels", 0.0, [](Finding& finding) {
                         const Replay replay("gen:stack?n=10000&x=0&y=0&w=2&h=2",
                                             {.width = 2, .height = 2, .knobs = {"k=8", "entry=z"}, .threads = 1});
                         for (const char* design : {"blender", "scoreboard", "peel-rop"}) {
                             const pipeline::RunResult run = replay.run(design);
                             finding.error(static_cast<double>(run.wrong_pixels + run.lost_fragments));
                         }
                     }});
}

/// A7 on a stream where each group of `places + 1` comes in reverse, so that its first one is `places` late.
struct Streamed {
    bool as_modelled = false; ///< the composite of a queue of k, by std::multimap
    bool as_sorted = false;   ///< that of the sorted stream
};

Streamed stream_of_groups(std::uint32_t k, std::uint32_t places) {
    using Fragment = std::vector<float>;
    const Program program = models::make_order_and_blend(k, 0.5F);
    std::vector<Fragment> sorted, moved;
    for (std::uint32_t i = 0; i < 24; ++i)
        sorted.push_back(
            {static_cast<float>(i % 5), static_cast<float>(i % 3), 1.0F, 0.03F * static_cast<float>(i + 1)});
    moved = sorted;
    for (std::size_t i = 0; i + places < moved.size(); i += places + 1)
        std::reverse(moved.begin() + static_cast<std::ptrdiff_t>(i),
                     moved.begin() + static_cast<std::ptrdiff_t>(i + places + 1));
    const auto composite = [](const std::vector<Fragment>& fragments) {
        std::vector<float> state{0, 0, 0, 1};
        for (const Fragment& fragment : fragments) {
            for (std::size_t channel = 0; channel < 3; ++channel) state[channel] += state[3] * 0.5F * fragment[channel];
            state[3] *= 0.5F;
        }
        return state;
    };
    std::multimap<float, Fragment> queue;
    std::vector<Fragment> popped;
    const auto pop = [&] {
        popped.push_back(queue.begin()->second);
        queue.erase(queue.begin());
    };
    for (const Fragment& fragment : moved) {
        queue.emplace(fragment[3], fragment);
        if (queue.size() > k) pop();
    }
    while (!queue.empty()) pop();
    const auto pixel = pixel_after(*program, moved);
    const auto behind = pixel.begin() + std::ptrdiff_t{k} * 4;
    const std::vector<float> state(behind, behind + 4);
    return {state == composite(popped), state == composite(sorted)};
}

/// Three strips, each over the next one, in one of 6 orders: the largest difference between what a load makes of them
/// and the composite of sorted layers.
double cycle_error(int order, const traces::Load& load) {
    const std::array<ScreenTriangle, 3> strips{{{{1, 2, 0.3F}, {1, 7, 0.3F}, {31, 25, 0.6F}},
                                                {{31, 27, 0.3F}, {31, 22, 0.3F}, {2, 26, 0.6F}},
                                                {{3, 31, 0.3F}, {8, 31, 0.3F}, {5, 1, 0.6F}}}};
    std::array<std::size_t, 3> places{0, 1, 2};
    for (int i = 0; i < order; ++i) std::next_permutation(places.begin(), places.end());
    const traces::Scene scene = screen_scene({strips[places[0]], strips[places[1]], strips[places[2]]});
    const ReplayOptions exact{.width = 32, .height = 32, .knobs = {"k=4"}, .threads = 1};
    ReplayOptions other = exact;
    other.workload = load.workload;
    other.knobs = load.settings;
    const Replay sorted(scene, exact), seen(scene, other);
    const std::vector<float>& picture = seen.frame.program ? seen.reference.picture : seen.reference.colour;
    double largest = 0.0;
    for (std::size_t i = 0; i < picture.size(); ++i)
        if (i % 4 != 3)
            largest = std::max(
                largest, std::fabs(static_cast<double>(picture[i]) - static_cast<double>(sorted.reference.picture[i])));
    return largest;
}

void add_order(std::vector<Case>& cases) {
    const auto all = [](Finding& finding, std::uint32_t more, bool expected) {
        for (const std::uint32_t k : {1U, 2U, 4U, 8U}) {
            const Streamed streamed = stream_of_groups(k, k + more - 1);
            finding.require(streamed.as_modelled, fmt::format("k = {}: as a queue of k", k));
            finding.require(streamed.as_sorted == expected, fmt::format("k = {}: sorted: {}", k, expected));
        }
    };
    cases.push_back({"kbuffer.nearly-sorted-below", Side::below, "A7: fragments k - 1 places from their sorted place",
                     "the composite of the sorted stream", "", 0.0,
                     [all](Finding& finding) { all(finding, 0, true); }});
    cases.push_back({"kbuffer.nearly-sorted-at", Side::at, "A7: fragments k places from their sorted place",
                     "the composite of the sorted stream", "", 0.0,
                     [all](Finding& finding) { all(finding, 1, true); }});
    cases.push_back({"kbuffer.nearly-sorted-above", Side::above, "A7: fragments k + 1 places from their sorted place",
                     "composited too early: another picture", "", 0.0,
                     [all](Finding& finding) { all(finding, 2, false); }});
    cases.push_back({"kbuffer.cycle-by-order", Side::below,
                     "three triangles that overlap in a cycle, blended in each of their 6 orders",
                     "no order gives the picture of sorted layers", "", 0.0, [](Finding& finding) {
                         for (int order = 0; order < 6; ++order)
                             finding.require(cycle_error(order, traces::blending_load("rgba32f")) > 0.05,
                                             fmt::format("order {} fails", order));
                     }});
    cases.push_back({"kbuffer.cycle-k1", Side::at,
                     "three triangles that overlap in a cycle, two layers deep, in each of their 6 orders: A7, k = 1",
                     "the picture of sorted layers: no fragment is more than one place late", "relative", 1e-6,
                     [](Finding& finding) {
                         traces::Load load = traces::layers_load(1, "rgbz");
                         load.settings.emplace_back("program=order-and-blend");
                         for (int order = 0; order < 6; ++order) finding.error(cycle_error(order, load));
                     }});
}

/// Checks K1: survivors before the limit of a stack of 64 at constant distance h are floor(63 / h) + 1.
void stack_survivors(Finding& finding, std::uint32_t distance) {
    const Replay replay("gen:stack?n=64&x=0&y=0&w=2&h=2",
                        {.width = 2, .height = 2, .knobs = {"k=64", "entry=z"}, .threads = 1});
    const auto image = pipeline::run_reference(replay.frame, replay.streams, distance, 1);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < 64; ++i) kept += image.kbuffer[i] <= 1.0F ? 1 : 0;
    const std::uint32_t expected = 63 / distance + 1;
    finding.error(static_cast<double>(kept) - expected);
}

void add_hazards(std::vector<Case>& cases) {
    cases.push_back({"kbuffer.stale-reads-none", Side::below, "64 layers read what is 1 quad old: every update is seen",
                     "64 survivors", "fragments", 0.0, [](Finding& finding) { stack_survivors(finding, 1); }});
    cases.push_back({"kbuffer.stale-reads-some", Side::at,
                     "64 layers read what is 8, 16 and 63 quads old: stale reads overwrite",
                     "floor(63 / H) + 1 survivors: 8, 4 and 2", "fragments", 0.0, [](Finding& finding) {
                         for (const std::uint32_t distance : {8U, 16U, 63U}) stack_survivors(finding, distance);
                     }});
    cases.push_back({"kbuffer.stale-reads-all", Side::above, "64 layers read what is 64 and 128 quads old",
                     "one survivor: all others are lost", "fragments", 0.0, [](Finding& finding) {
                         for (const std::uint32_t distance : {64U, 128U}) stack_survivors(finding, distance);
                     }});
    cases.push_back({"kbuffer.shader-updates", Side::whole,
                     "64 layers on one quad: a shader that reads and stores its own pixel, unprotected and protected",
                     "hazards and wrong pixels without protection, none with it; all wrong pixels explained", "pixels",
                     0.0, [](Finding& finding) {
                         const Replay replay("gen:stack?n=64&x=0&y=0&w=2&h=2",
                                             {.width = 2, .height = 2, .knobs = {"k=4"}, .threads = 1});
                         const pipeline::RunResult bare = replay.run("existing");
                         finding.require(bare.hazards.total() > 0 && bare.wrong_pixels > 0, "existing goes wrong");
                         finding.error(static_cast<double>(bare.unexplained_pixels()));
                         for (const char* design : {"scoreboard", "blender", "multipass", "interlock", "peel-rop"}) {
                             const pipeline::RunResult run = replay.run(design);
                             finding.error(static_cast<double>(run.wrong_pixels + run.hazards.total()));
                         }
                     }});
}

/// A6 keeps k of the four surfaces of two nested objects; what CSG makes of "A & B" behind them.
std::vector<bool> csg_parity(std::uint32_t k) {
    const traces::CsgExpression both("A & B", 2);
    traces::CsgWalk walk(both, 2);
    const Program program = models::make_nearest_k(models::EntryKind::zo, k);
    // A from 0.1 to 0.4, B from 0.2 to 0.3: both hold between 0.2 and 0.3.
    const auto pixel = pixel_after(*program, {{0.4F, 0}, {0.3F, 1}, {0.2F, 1}, {0.1F, 0}});
    std::vector<bool> holds;
    for (std::uint32_t i = 0; i < k; ++i)
        if (pixel[std::size_t{i} * 2] != models::empty_depth)
            holds.push_back(walk.cross(static_cast<std::uint32_t>(pixel[i * 2 + 1])));
    return holds;
}

void add_csg(std::vector<Case>& cases) {
    cases.push_back({"kbuffer.csg-parity-below", Side::below,
                     "CSG, two nested objects, k = 3 of 4 surfaces: the exit of A is dropped",
                     "the surface at the second; the ray never leaves A", "", 0.0, [](Finding& finding) {
                         finding.require(csg_parity(3) == std::vector<bool>{false, true, false}, "in, both, A only");
                     }});
    cases.push_back({"kbuffer.csg-parity-at", Side::at, "CSG, two nested objects, k = 4 of 4 surfaces",
                     "the expression holds behind the second surface only", "", 0.0, [](Finding& finding) {
                         finding.require(csg_parity(4) == std::vector<bool>{false, true, false, false}, "all four");
                     }});
    cases.push_back({"kbuffer.csg-parity-above", Side::above, "CSG, two nested objects, k = 8 for 4 surfaces",
                     "as with four entries; empty ones are no surfaces", "", 0.0, [](Finding& finding) {
                         finding.require(csg_parity(8) == std::vector<bool>{false, true, false, false}, "all four");
                     }});
}

/// Four layers, the deepest at 0.5, and 2,000 fragments at one depth behind them: what a unit that rejects early keeps.
void early_reject(Finding& finding, float depth) {
    std::vector<float> depths{0.2F, 0.3F, 0.4F, 0.5F};
    depths.insert(depths.end(), 2000, depth); // more than are on their way when the first bounds come back
    const Replay replay(layers_of(2, 2, depths), {.width = 2, .height = 2, .knobs = {"k=4", "entry=z"}, .threads = 1});
    for (std::size_t i = 0; i < depths.size(); ++i)
        depths[i] = replay.streams[0].depths[i * 2][0]; // two triangles each
    std::stable_sort(depths.begin(), depths.end());
    for (const char* rule : {"peel-rop.early_reject=pixel", "peel-rop.early_reject=tile"}) {
        const pipeline::RunResult run = replay.run("peel-rop", {rule});
        finding.error(static_cast<double>(run.wrong_pixels));
        for (std::size_t i = 0; i < 4; ++i) finding.error(ulps(run.kbuffer[i], depths[i]));
        std::uint64_t rejected = 0;
        for (const pipeline::PassResult& pass : run.passes)
            if (pass.counters->contains("early_depth"))
                rejected += pass.counters->at("early_depth").at("fragments_beyond").get<std::uint64_t>();
        finding.require(rejected > 0, "some are rejected early");
    }
}

void add_early_reject(std::vector<Case>& cases) {
    cases.push_back({"kbuffer.early-reject-nearer", Side::below,
                     "early rejection against the deepest entry: 2,000 fragments one float nearer than it",
                     "no wrong pixel: none may be rejected", "ulp", 0.0,
                     [](Finding& finding) { early_reject(finding, next_down(0.5F)); }});
    cases.push_back({"kbuffer.early-reject-equal", Side::at,
                     "early rejection against the deepest entry: 2,000 fragments as deep", "no wrong pixel", "ulp", 0.0,
                     [](Finding& finding) { early_reject(finding, 0.5F); }});
    cases.push_back({"kbuffer.early-reject-farther", Side::above,
                     "early rejection against the deepest entry: 2,000 fragments one float behind it", "no wrong pixel",
                     "ulp", 0.0, [](Finding& finding) { early_reject(finding, next_up(0.5F)); }});
}

} // namespace reports::stability::kbuffer

std::vector<reports::stability::Case> reports::stability::kbuffer_cases() {
    std::vector<Case> cases;
    for (const std::uint32_t k : {1U, 4U, 64U}) kbuffer::add_overflow(cases, k);
    kbuffer::add_equal_depths(cases);
    kbuffer::add_ten_thousand(cases);
    kbuffer::add_order(cases);
    kbuffer::add_hazards(cases);
    kbuffer::add_csg(cases);
    kbuffer::add_early_reject(cases);
    return cases;
}
