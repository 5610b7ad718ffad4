#include "reports/remarks.hpp"

#include "sim/counted.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace reports {

namespace {

std::uint64_t culled(const pipeline::RunResult& run, const char* how) {
    if (!run.stages->contains("clip_cull")) return 0;
    return run.stages->at("clip_cull")["counters"].value(how, std::uint64_t{0});
}

} // namespace

std::vector<std::string> each_once(const std::vector<std::string>& notes) {
    std::vector<std::string> list;
    for (const std::string& note : notes)
        if (std::find(list.begin(), list.end(), note) == list.end()) list.push_back(note);
    return list;
}

std::string nothing_drawn(const pipeline::RunResult& run) {
    if (run.fragments != 0) return "";
    std::vector<std::string> why;
    const auto add = [&](const char* counter, const char* words) {
        if (const std::uint64_t number = culled(run, counter); number != 0)
            why.push_back(fmt::format("{} {}", sim::with_commas(number), words));
    };
    add("culled_outside", "outside of the view");
    add("culled_facing", "facing away");
    add("culled_degenerate", "without area");
    const std::uint64_t triangles = culled(run, "primitives");
    return fmt::format("nothing was drawn, so these numbers say nothing: no fragment reached the pixels; of {}{}{}",
                       sim::counted(triangles, "triangle"), why.empty() ? " all miss the centres of the pixels" : ", ",
                       fmt::join(why, ", "));
}

std::vector<std::string> remarks(const Comparison& comparison) {
    std::vector<std::string> list;
    const bool empty = std::all_of(comparison.runs.begin(), comparison.runs.end(),
                                   [](const pipeline::RunResult& run) { return run.fragments == 0; });
    if (empty && !comparison.runs.empty()) list.push_back(nothing_drawn(comparison.runs.front()));
    if (!comparison.same_runs.empty()) list.push_back(comparison.same_runs);
    list.insert(list.end(), comparison.scene.notes.begin(), comparison.scene.notes.end());
    return each_once(list);
}

std::string remarks_text(const std::vector<std::string>& remarks, TerminalStyle style) {
    std::string text = remarks.empty() ? "" : "\nNotes:\n";
    for (const std::string& remark : remarks) text += wrap("  " + remark, style.columns, 4);
    return text;
}

} // namespace reports
