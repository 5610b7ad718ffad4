#include "tests/support/design_runs.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

namespace support {

const Settings jitter{"memory.controller.jitter_cycles=300"};

bool DesignCase::allows(const std::string& design) const {
    const std::vector<std::string> able = replay.designs();
    return std::find(able.begin(), able.end(), design) != able.end();
}

const std::vector<DesignCase>& design_cases() {
    static const std::vector<DesignCase> list = [] {
        std::vector<DesignCase> made;
        made.emplace_back("gen:discs?n=60&overlap=8&width=32&height=32", ReplayOptions{32, 32});
        made.emplace_back("gen:stack?n=12&x=1&y=1&w=29&h=29&order=random",
                          ReplayOptions{32, 32, "transparency", "auto", {"k=2"}});
        made.emplace_back("gen:random-quads?n=2000&area=1024",
                          ReplayOptions{32, 32, "transparency", "auto", {"entry=z", "k=16"}});
        made.emplace_back("gen:blob?triangles=3000", ReplayOptions{48, 48});
        made.emplace_back("gen:grid-soup?boxes=60&boxes_per_draw=7",
                          ReplayOptions{48, 48, "transparency", "auto", {"k=8"}});
        made.emplace_back("gen:grass?blades=300", ReplayOptions{48, 48, "transparency", "auto", {"k=1"}});
        made.emplace_back("gen:discs?n=60&overlap=8&width=32&height=32", ReplayOptions{32, 32, "opaque"});
        made.emplace_back("gen:discs?n=30&overlap=6&width=24&height=22",
                          ReplayOptions{.width = 24, .height = 22, .knobs = {"k=2"}, .samples = 4});
        made.emplace_back("gen:blob?triangles=400",
                          ReplayOptions{.width = 15, .height = 21, .knobs = {"entry=z", "k=4"}, .samples = 8});
        made.emplace_back("gen:blob?triangles=400",
                          ReplayOptions{.width = 16, .height = 17, .workload = "opaque", .samples = 8});
        return made;
    }();
    return list;
}

const std::vector<std::pair<std::string, Settings>>& design_variants() {
    static const std::vector<std::pair<std::string, Settings>> list = [] {
        std::vector<std::pair<std::string, Settings>> made;
        for (const std::string& design : design_ids()) made.push_back({design, {}});
        made.push_back({"existing", {"existing.visibility=rop_cache", "existing.tex_coherence=invalidate_on_write"}});
        made.push_back({"existing", {"existing.visibility=never_until_flush", "existing.flush_triangles=16"}});
        made.push_back(
            {"existing", {"existing.atomic_reads=true", "existing.flush_draws=true", "existing.drain=false"}});
        made.push_back({"scoreboard",
                        {"scoreboard.granularity=tile8", "scoreboard.visibility=writeback", "scoreboard.entries=9"}});
        made.push_back({"blender", {"blender.interlock=forward"}});
        made.push_back({"blender", {"blender.interlock=none", "blender.latency=200"}});
        made.push_back({"interlock", {"interlock.area=tile", "interlock.grants_per_clk=1"}});
        made.push_back({"interlock", {"interlock.ordered=false"}});
        made.push_back({"peel-rop", {"peel-rop.retirement=out_of_order", "peel-rop.early_reject=pixel"}});
        made.push_back({"linked-list", {"linked-list.nodes=400"}});
        made.push_back({"stencil-routed", {"stencil-routed.samples=2", "stencil-routed.passes=3"}});
        made.push_back({"batched", {"batched.batches.batch=3", "batched.batches.drain=false"}});
        return made;
    }();
    return list;
}

Settings joined(Settings settings, const Settings& more) {
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
}

std::string run_text(const DesignCase& one, const std::string& design, const Settings& settings) {
    return fmt::format("{} {} on {} {} {}, {} samples", design, fmt::join(settings, " "), one.options.workload.name(),
                       one.scene, fmt::join(one.options.knobs, " "), one.options.samples);
}

void for_every_run(const Settings& more,
                   const std::function<void(const DesignCase&, const std::string&, const Settings&)>& check,
                   std::size_t every) {
    std::size_t number = 0;
    for (const DesignCase& one : design_cases())
        for (const auto& [design, settings] : design_variants()) {
            if (!one.allows(design) || number++ % every != 0) continue;
            SCOPED_TRACE(run_text(one, design, settings));
            check(one, design, joined(settings, more));
        }
}

} // namespace support
