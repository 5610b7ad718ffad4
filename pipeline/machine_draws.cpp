// Counters by draw, and by pass and draw.
#include "pipeline/machine_units.hpp"
#include "sim/described.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace pipeline {

namespace {

constexpr std::array output_counters{"quads",           "fragments",   "samples_passed",
                                     "hazardous_quads", "first_cycle", "last_cycle"};

std::vector<std::string> names_of_draw_counters() {
    const auto& geometry = sim::field_names<GeometryDrawStats>;
    std::vector<std::string> names(geometry.begin(), geometry.end());
    names.insert(names.end(), output_counters.begin(), output_counters.end());
    for (const auto client : memory_client_names) names.push_back(fmt::format("dram_{}_bytes", client));
    return names;
}

} // namespace

std::vector<std::uint64_t> Machine::draw_counters(std::uint32_t draw) const {
    DrawOutput output;
    for (const Rop& rop : units_->rops) {
        const DrawOutput& part = rop.draw_outputs()[draw];
        output.quads += part.quads;
        output.fragments += part.fragments;
        output.passed += part.passed;
        output.hazards += part.hazards;
        output.first_cycle = std::min(output.first_cycle, part.first_cycle);
        output.last_cycle = std::max(output.last_cycle, part.last_cycle);
    }
    std::vector<std::uint64_t> counters;
    counters.reserve(sim::field_names<GeometryDrawStats>.size() + output_counters.size() + memory_client_count);
    const GeometryDrawStats geometry = units_->front.draw_stats(draw);
    sim::for_each_field(geometry,
                        [&counters](const auto&, const sim::Counter& counter) { counters.push_back(counter.value); });
    counters.insert(counters.end(), {output.quads, output.fragments, output.passed, output.hazards,
                                     output.quads == 0 ? 0 : output.first_cycle, output.last_cycle});
    const MemoryBytes bytes = units_->memory.draw_bytes(draw);
    counters.insert(counters.end(), bytes.begin(), bytes.end());
    return counters;
}

Machine::DrawSnapshot Machine::counters_of_draws(const FragmentStream& stream) const {
    DrawSnapshot snapshot;
    std::vector<bool> seen(frame_->draws.size());
    for (const DrawRange& range : stream.draws) {
        if (seen[range.draw]) continue;
        seen[range.draw] = true;
        snapshot.push_back({range.draw, draw_counters(range.draw)});
    }
    return snapshot;
}

// Cycles of the first and last quad are those of all passes so far: only what adds up is said of one.
void Machine::book_draws(DrawSnapshot&& before) {
    const std::size_t first_cycle = sim::field_names<GeometryDrawStats>.size() + 4;
    for (DrawCounters& draw : before) {
        std::vector<std::uint64_t> counters = draw_counters(draw.draw);
        for (std::size_t i = 0; i < counters.size(); ++i) counters[i] -= draw.counters[i];
        counters[first_cycle] = counters[first_cycle + 1] = 0;
        if (std::any_of(counters.begin(), counters.end(), [](std::uint64_t count) { return count != 0; }))
            pass_draws_.push_back({static_cast<std::uint32_t>(passes_.size() - 1), draw.draw, std::move(counters)});
    }
}

void Machine::collect_draws(RunResult& result) {
    result.draw_counters = names_of_draw_counters();
    for (std::uint32_t draw = 0; draw < frame_->draws.size(); ++draw)
        result.draws.push_back({frame_->draws[draw].name, draw, draw_counters(draw)});
    result.pass_draws = std::move(pass_draws_);
}

} // namespace pipeline
