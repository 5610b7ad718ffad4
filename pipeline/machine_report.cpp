// What a machine says after a run: pixels against the reference, hazards, counters by stage, pass and draw.
#include "pipeline/functional/sample_pattern.hpp"
#include "pipeline/functional/surface_values.hpp"
#include "pipeline/image_difference.hpp"
#include "pipeline/machine_units.hpp"
#include "pipeline/memory/unit_report.hpp"
#include "pipeline/on_chip_area.hpp"
#include "pipeline/peel_resolution.hpp"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace pipeline {

namespace {

using Json = nlohmann::ordered_json;

template <class Units, class Stats>
Json units_report(const Units& units, const Stats& sum) {
    Json report;
    report["units"] = units.size();
    report["counters"] = sim::to_json(sum);
    for (const auto& unit : units) add_activity(report["activity"], unit);
    return report;
}

template <class Unit>
Json one_unit_report(const Unit& unit) {
    Json report = unit_report(unit);
    report["units"] = 1;
    return report;
}

Json cache_report(std::uint64_t hits, std::uint64_t misses) {
    const std::uint64_t accesses = hits + misses;
    return {{"accesses", accesses},
            {"hits", hits},
            {"misses", misses},
            {"hit_rate", accesses == 0 ? 0.0 : static_cast<double>(hits) / static_cast<double>(accesses)}};
}

Json link_report(std::uint64_t bytes, std::uint64_t fragments) {
    return {{"bytes", bytes},
            {"per_fragment", fragments == 0 ? 0.0 : static_cast<double>(bytes) / static_cast<double>(fragments)}};
}

/// The bits that any sample of a pixel has.
std::vector<std::uint8_t> of_pixels(const View& view, std::vector<std::uint8_t> places) {
    const std::size_t pixels = std::size_t{view.width} * view.height;
    for (std::uint32_t sample = 1; sample < view.samples; ++sample) {
        const auto plane = plane_of_sample(view, sample, std::span(places), 1);
        for (std::size_t pixel = 0; pixel < pixels; ++pixel) places[pixel] |= plane[pixel];
    }
    places.resize(pixels);
    return places;
}

} // namespace

MachineStats Machine::Units::stats() const {
    MachineStats sum;
    sum.geometry = front.stats();
    sum.raster = rasterizer->stats();
    if (early_depth) sum.early_depth = early_depth->stats();
    sum.scheduler = scheduler->stats();
    for (const FragmentPipeline& pipe : pipes) sim::add(sum.fragment, pipe.stats());
    if (locks) sum.locks = locks->stats();
    sum.reorder_buffer = reorder_buffer->stats();
    sum.crossbar = crossbar->stats();
    for (const Rop& rop : rops) sim::add(sum.rop, rop.stats());
    sum.memory = memory.controller_stats();
    return sum;
}

void Machine::list_units(RunResult& result) const {
    const auto part = [&result](bool built, const char* unit, std::string reason) {
        if (built)
            result.built.emplace_back(unit);
        else
            result.left_out.emplace_back(unit, std::move(reason));
    };
    const Units& units = *units_;
    const bool shader_site = units.payloads.has_value();
    const auto because = [this](const char* reason) {
        return std::string(frame_->needs.kbuffer ? reason : "no pass runs a modify program");
    };
    for (const char* unit : {"command processor", "vertex reuse", "vertex fetch", "vertex shader", "primitive assembly",
                             "clip and cull", "triangle setup", "rasterizer", "fragment scheduler",
                             "fragment pipelines", "reorder buffer", "crossbar", "ROP partitions", "memory partitions"})
        part(true, unit, {});
    part(units.front.has_index_fetch(), "index fetch", "no draw is indexed");
    part(units.early_depth.has_value(), "early depth test", "no pass tests a depth surface that it does not write");
    part(textures_linked_, "texture path to memory", "no texture, no peeled layer and no full-screen pass is read");
    part(plan_.scheduling.guard != nullptr, "dispatch guard and side buffer",
         because("the design lets every quad into the pipes"));
    part(units.locks.has_value(), "lock table", because("the design's shaders have no critical section"));
    part(units.lists.has_value(), "lists of fragments", because("the design keeps no fragments for later"));
    part(shader_site, "k-buffer read path of the shaders",
         because("the design does not read the k-buffer in the shader"));
    part(plan_.site == UpdateSite::blender && units.kbuffer,
         plan_.blender.unit == BlendUnit::program ? "programmable blender"
         : plan_.blender.unit == BlendUnit::peel  ? "peeling unit"
                                                  : "atomic units",
         because("the design does not modify pixels in the ROP"));
    part(units.kbuffer.has_value(), "k-buffer surface and its tile cache",
         because("the design keeps its layers in depth and colour surfaces"));
    part(uses_depth(), "depth tile cache", "no pass tests or writes depth");
    part(uses_colour(), "colour tile cache", "no pass writes colour");
    for (const LeftOut& item : frame_->left_out)
        if (std::none_of(result.left_out.begin(), result.left_out.end(),
                         [&](const auto& listed) { return listed.first == item.unit; }) &&
            std::find(result.built.begin(), result.built.end(), item.unit) == result.built.end())
            result.left_out.emplace_back(item.unit, item.reason);
}

namespace {

// What a place is wrong by, as bits.
constexpr std::uint8_t own_fault = 1, of_inputs = 2;

} // namespace

bool Machine::faultless(SurfaceId surface) const {
    return surface != no_surface &&
           std::all_of(judgements_.begin(), judgements_.end(), [&](const PassJudgement& judgement) {
               return judgement.surface != frame_->surfaces[surface].name || judgement.wrong_places == 0;
           });
}

void Machine::collect_pixels(RunResult& result, const ReferenceImage& reference) const {
    std::vector<std::uint8_t> wrong, tied;
    if (frame_->needs.kbuffer) {
        result.kbuffer = entries_of(units_->surfaces, frame_->main_kbuffer());
        KBufferDifference difference = compare_kbuffers(*frame_->program, result.kbuffer, reference.kbuffer);
        wrong = std::move(difference.wrong);
        result.lost_fragments = difference.lost_fragments;
        tied = std::move(difference.tied);
        result.layers = std::move(difference.layers);
    }
    const SurfaceStore& surfaces = units_->surfaces;
    result.colour = colours_of(surfaces, frame_->main_colour());
    result.depth = depths_of(surfaces, frame_->main_depth());
    result.stencil = stencils_of(surfaces, frame_->main_depth());
    result.shown = surfaces.shown();
    for (SurfaceId i = 0; i < surfaces.count(); ++i) result.surfaces.push_back({surfaces.info(i), surfaces.memory(i)});
    const std::vector<std::uint8_t> fixed = wrong_fixed_places(result, reference);
    wrong.resize(frame_->view_of_kbuffer().places());
    if (frame_->kbuffer_seen_from_elsewhere()) { // surfaces of other pixels, which no hazard there explains
        for (const std::uint8_t fault : fixed) {
            result.wrong_because.unexplained += (fault & own_fault) != 0 ? 1 : 0;
            result.wrong_because.inputs += fault == of_inputs ? 1 : 0;
        }
        result.wrong_pixels = result.wrong_because.unexplained + result.wrong_because.inputs;
    } else {
        for (std::size_t place = 0; place < wrong.size(); ++place) wrong[place] |= fixed[place];
    }
    judge_pixels(result, reference, std::move(wrong), tied);
}

std::vector<std::uint8_t> Machine::wrong_fixed_places(const RunResult& result, const ReferenceImage& reference) const {
    std::vector<std::uint8_t> wrong(frame_->view.places());
    const std::uint8_t colour_fault = faultless(frame_->main_colour()) ? of_inputs : own_fault;
    const std::uint8_t depth_fault = faultless(frame_->main_depth()) ? of_inputs : own_fault;
    if (!result.colour.empty()) {
        CHECK(result.colour.size() == reference.colour.size());
        for (std::size_t at = 0; at < result.colour.size(); ++at)
            if (std::bit_cast<std::uint32_t>(result.colour[at]) != std::bit_cast<std::uint32_t>(reference.colour[at]))
                wrong[at / 4] |= colour_fault;
    }
    for (std::size_t place = 0; place < result.depth.size() && place < reference.depth.size(); ++place)
        if (result.depth[place] != reference.depth[place]) wrong[place] |= depth_fault;
    for (std::size_t place = 0; place < result.stencil.size() && place < reference.stencil.size(); ++place)
        if (result.stencil[place] != reference.stencil[place]) wrong[place] |= depth_fault;
    return wrong;
}

namespace {

// Of a place, or of a pixel: what is true of any of its samples. Wrong for none of these reasons: by its inputs.
constexpr std::uint8_t is_wrong = 1, more_than_tied = 2, has_overflow = 4, by_hazard = 8, by_tie = 16, by_format = 32,
                       by_eps = 64, unexplained = 128;

void count_reason(WrongBecause& because, std::uint8_t facts) {
    std::uint64_t& reason = (facts & unexplained) != 0    ? because.unexplained
                            : (facts & by_hazard) != 0    ? because.hazard
                            : (facts & by_tie) != 0       ? because.tie
                            : (facts & by_format) != 0    ? because.depth_format
                            : (facts & by_eps) != 0       ? because.eps
                            : (facts & has_overflow) != 0 ? because.overflow
                                                          : because.inputs;
    ++reason;
}

} // namespace

// Of wrong places that nothing else explains: what peeling cannot tell apart.
void Machine::explain_peeling(std::vector<std::uint8_t>& facts) const {
    if (!peels()) return;
    std::vector<std::size_t> places;
    for (std::size_t place = 0; place < facts.size(); ++place)
        if ((facts[place] & unexplained) != 0) places.push_back(place);
    if (places.empty()) return;
    std::size_t stream = 0;
    for (const Pass& pass : frame_->passes) {
        if (pass.runs_program()) break;
        stream += pass.rasterizes() ? 1 : 0;
    }
    const std::vector<PeelLoss> losses = peel_losses(plan_.passes, streams_[stream], places);
    for (std::size_t i = 0; i < places.size(); ++i)
        if (losses[i] != PeelLoss::none) {
            facts[places[i]] &= static_cast<std::uint8_t>(~unexplained);
            facts[places[i]] |= losses[i] == PeelLoss::eps ? by_eps : by_format;
        }
}

// A pixel is wrong where any of its samples is, and so on; tied where all that is wrong of it is a tie.
void Machine::judge_pixels(RunResult& result, const ReferenceImage& reference, std::vector<std::uint8_t> wrong,
                           const std::vector<std::uint8_t>& tied) const {
    for (std::size_t place = 0; frame_->needs.kbuffer && place < wrong.size(); ++place) {
        const bool overflow = overflowed(place, reference.depth_complexity[place]);
        const bool tie = tied[place] != 0;
        std::uint8_t facts = overflow ? has_overflow : 0;
        if (wrong[place] != 0) {
            facts |= is_wrong;
            if (!tie) facts |= more_than_tied;
            if (explained(place))
                facts |= by_hazard;
            else if (!overflow && wrong[place] != of_inputs)
                facts |= plan_.order_free && tie ? by_tie : unexplained;
        }
        wrong[place] = facts;
    }
    if (frame_->needs.kbuffer) explain_peeling(wrong);
    result.wrong_mask = of_pixels(frame_->view_of_kbuffer(), std::move(wrong));
    for (std::uint8_t& facts : result.wrong_mask) {
        const bool counted = frame_->needs.kbuffer && (facts & is_wrong) != 0;
        result.wrong_pixels += (facts & is_wrong) != 0 ? 1 : 0;
        result.tied_pixels += counted && (facts & more_than_tied) == 0 ? 1 : 0;
        result.overflow_pixels += (facts & has_overflow) != 0 ? 1 : 0;
        if (counted) count_reason(result.wrong_because, facts);
        facts &= is_wrong;
    }
}

bool Machine::explained(std::size_t place) const {
    const std::size_t width = frame_->view_of_kbuffer().width;
    const auto x = static_cast<std::uint32_t>(place % width), y = static_cast<std::uint32_t>(place / width);
    return units_->kbuffer && units_->history->classes(units_->pass.layout.block_of(x, y), y % 2 * 2 + x % 2) != 0;
}

std::vector<HazardLedger::Access> Machine::accesses() const {
    std::vector<HazardLedger::Access> all;
    for (const Rop& rop : units_->rops)
        all.insert(all.end(), rop.ledger().accesses().begin(), rop.ledger().accesses().end());
    return all;
}

void Machine::collect_hazards(RunResult& result) const {
    const Units& units = *units_;
    std::uint64_t staleness = 0;
    for (const Rop& rop : units.rops) {
        const HazardLedger& ledger = rop.ledger();
        result.hazards += ledger.counts();
        staleness += ledger.staleness_sum();
        result.max_staleness = std::max(result.max_staleness, ledger.staleness_max());
        const auto& distances = ledger.distances();
        if (result.hazard_distance.size() < distances.size()) result.hazard_distance.resize(distances.size());
        for (std::size_t bin = 0; bin < distances.size(); ++bin) result.hazard_distance[bin] += distances[bin];
        result.pairs.insert(result.pairs.end(), ledger.pairs().begin(), ledger.pairs().end());
    }
    std::stable_sort(result.pairs.begin(), result.pairs.end(),
                     [](const HazardPair& a, const HazardPair& b) { return a.read < b.read; });
    const std::uint64_t total = result.hazards.total();
    result.mean_staleness = total == 0 ? 0.0 : static_cast<double>(staleness) / static_cast<double>(total);
    result.lost_updates = lost_before_clears_ + (units.kbuffer ? units.kbuffer->lost_updates() : 0);

    if (total == 0) return;
    const SurfaceLayout& layout = units.pass.layout;
    result.hazard_mask.resize(frame_->view_of_kbuffer().places());
    for (std::uint32_t y = 0; y < layout.rows(); ++y)
        for (std::uint32_t x = 0; x < layout.width; ++x)
            result.hazard_mask[std::size_t{y} * layout.width + x] =
                units.history->classes(layout.block_of(x, y), y % 2 * 2 + x % 2);
    if (layout.samples == 1) return;
    result.hazard_mask = of_pixels(frame_->view_of_kbuffer(), std::move(result.hazard_mask));
    const auto spared = std::count(result.hazard_mask.begin(), result.hazard_mask.end(), 0);
    result.hazards.pixels = result.hazard_mask.size() - static_cast<std::size_t>(spared);
}

void Machine::collect_counters(RunResult& result) {
    const Units& units = *units_;
    const MachineStats stats = units.stats();
    result.fragments = stats.rop.fragments;
    Json& stages = *result.stages;
    stages = units.front.report();
    stages["rasterizer"] = one_unit_report(*units.rasterizer);
    if (units.early_depth) stages["early_depth_test"] = one_unit_report(*units.early_depth);
    stages["fragment_scheduler"] = one_unit_report(*units.scheduler);
    stages["fragment_pipeline"] = units_report(units.pipes, stats.fragment);
    if (units.locks) stages["lock_table"] = one_unit_report(*units.locks);
    stages["reorder_buffer"] = one_unit_report(*units.reorder_buffer);
    stages["crossbar"] = one_unit_report(*units.crossbar);
    stages["rop"] = units_report(units.rops, stats.rop);
    const Json memory = units.memory.report();
    for (const auto& item : memory.items()) stages[item.key()] = item.value();

    for (const auto& stage : stages.items()) {
        double total = 0;
        for (const auto& activity : stage.value()["activity"].items()) total += activity.value().get<double>();
        for (const auto& activity : stage.value()["activity"].items())
            result.stalls[stage.key()][activity.key()] = total == 0 ? 0.0 : activity.value().get<double>() / total;
    }

    const auto tile_cache = [&result](const char* name, const TileCacheStats& tiles) {
        if (tiles.accesses != 0) result.caches[name] = cache_report(tiles.hits, tiles.misses);
    };
    collect_vertex_caches(result);
    const TextureCacheStats& l1 = stats.fragment.l1;
    if (l1.texture_hits + l1.texture_misses != 0)
        result.caches["texture_l1"] = cache_report(l1.texture_hits, l1.texture_misses);
    if (l1.kbuffer_hits + l1.kbuffer_misses + l1.kbuffer_merged != 0)
        result.caches["texture_l1_kbuffer"] = cache_report(l1.kbuffer_hits + l1.kbuffer_merged, l1.kbuffer_misses);
    tile_cache("depth_tiles", stats.rop.depth_tiles);
    tile_cache("colour_tiles", stats.rop.colour_tiles);
    tile_cache("kbuffer_tiles", stats.rop.kbuffer_tiles);

    std::uint64_t dram = 0;
    for (const sim::Counter& bytes : stats.memory.bytes) dram += bytes;
    result.bytes["dram"] = link_report(dram, result.fragments);
    for (std::size_t client = 0; client < memory_client_count; ++client)
        if (stats.memory.bytes[client] != 0)
            result.bytes[fmt::format("dram_{}", memory_client_names[client])] =
                link_report(stats.memory.bytes[client], result.fragments);
    result.bytes["crossbar"] = link_report(stats.crossbar.bytes, result.fragments);

    result.area = area_json(on_chip_area(gpu_, *frame_, *design_));
    collect_draws(result);
}

void Machine::collect_vertex_caches(RunResult& result) const {
    const GeometryStats geometry = units_->front.stats();
    result.caches["post_transform"] = cache_report(geometry.vertex_reuse.hits, geometry.vertex_reuse.misses);
    result.caches["pre_transform"] = cache_report(geometry.vertex_fetch.cache.hits, geometry.vertex_fetch.cache.misses);
}

} // namespace pipeline
