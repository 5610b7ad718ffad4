// Two results, member by member: what support::difference() says.
#include "sim/described_json.hpp"
#include "tests/support/replay.hpp"

#include <bit>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string_view>
#include <tuple>

namespace support {

namespace {

using pipeline::RunResult;

auto key(const pipeline::HazardPair& pair) {
    return std::tuple(pair.x, pair.y, pair.cause, pair.kind, pair.victim, pair.aggressor, pair.missing, pair.read,
                      pair.write);
}

auto key(const pipeline::HazardCounts& counts) { return std::tuple(counts.by, counts.pixels); }

class Comparison {
  public:
    template <class T>
    void value(std::string_view name, const T& a, const T& b) {
        if (first_.empty() && !(a == b)) first_ = name;
    }

    // Bit by bit, so that a NaN equals itself and -0 is not 0.
    void floats(const char* name, const std::vector<float>& a, const std::vector<float>& b) {
        if (!first_.empty()) return;
        if (a.size() != b.size()) first_ = fmt::format("{}: {} and {} values", name, a.size(), b.size());
        for (std::size_t i = 0; first_.empty() && i < a.size(); ++i)
            if (std::bit_cast<std::uint32_t>(a[i]) != std::bit_cast<std::uint32_t>(b[i]))
                first_ = fmt::format("{}[{}]: {} and {}", name, i, a[i], b[i]);
    }

    // The text of both is compared, too: the order of keys is part of a result.
    void json(const std::string& name, const nlohmann::ordered_json& a, const nlohmann::ordered_json& b) {
        if (!first_.empty() || a.dump() == b.dump()) return;
        if (a.is_object() && b.is_object())
            for (const auto& item : a.items())
                if (b.contains(item.key())) json(name + "/" + item.key(), item.value(), b.at(item.key()));
        if (first_.empty()) first_ = fmt::format("{}: {} and {}", name, a.dump(), b.dump());
    }

    template <class List, class Compare>
    void list(const char* name, const List& a, const List& b, Compare compare) {
        if (!first_.empty()) return;
        if (a.size() != b.size()) {
            first_ = fmt::format("{}: {} and {} elements", name, a.size(), b.size());
            return;
        }
        for (std::size_t i = 0; first_.empty() && i < a.size(); ++i) compare(a[i], b[i]);
    }

    std::string take() { return std::move(first_); }

  private:
    std::string first_;
};

} // namespace

std::string difference(const RunResult& a, const RunResult& b) {
    Comparison compare;
    compare.value("design", a.design, b.design);
    compare.value("core_mhz", a.core_mhz, b.core_mhz);
    compare.json("stages", a.stages, b.stages);
    compare.value("cycles", a.cycles, b.cycles);
    compare.value("fragments", a.fragments, b.fragments);
    compare.value("hazards", key(a.hazards), key(b.hazards));
    compare.list("pairs", a.pairs, b.pairs,
                 [&](const auto& x, const auto& y) { compare.value("pair", key(x), key(y)); });
    compare.value("hazard_distance", a.hazard_distance, b.hazard_distance);
    compare.value("max_staleness", a.max_staleness, b.max_staleness);
    compare.value("mean_staleness", a.mean_staleness, b.mean_staleness);
    compare.value("lost_updates", a.lost_updates, b.lost_updates);
    compare.value("wrong_pixels", a.wrong_pixels, b.wrong_pixels);
    compare.json("wrong_because", sim::to_json(a.wrong_because), sim::to_json(b.wrong_because));
    compare.value("lost_fragments", a.lost_fragments, b.lost_fragments);
    compare.list("layers", a.layers, b.layers, [&](const auto& x, const auto& y) {
        compare.value("layer", std::tuple(x.missing, x.duplicate, x.unsorted),
                      std::tuple(y.missing, y.duplicate, y.unsorted));
    });
    compare.floats("kbuffer", a.kbuffer, b.kbuffer);
    compare.floats("colour", a.colour, b.colour);
    compare.value("hazard_mask", a.hazard_mask, b.hazard_mask);
    compare.value("wrong_mask", a.wrong_mask, b.wrong_mask);
    compare.value("built", a.built, b.built);
    compare.value("left_out", a.left_out, b.left_out);
    compare.json("stalls", a.stalls, b.stalls);
    compare.json("caches", a.caches, b.caches);
    compare.json("bytes", a.bytes, b.bytes);
    compare.json("area", a.area, b.area);
    compare.list("passes", a.passes, b.passes, [&](const auto& x, const auto& y) {
        compare.value("pass", std::tuple(x.name, x.first_cycle, x.cycles), std::tuple(y.name, y.first_cycle, y.cycles));
        compare.json("pass " + x.name, x.counters, y.counters);
    });
    compare.value("draw_counters", a.draw_counters, b.draw_counters);
    compare.list("draws", a.draws, b.draws, [&](const auto& x, const auto& y) {
        compare.value("draw", std::tuple(x.name, x.draw), std::tuple(y.name, y.draw));
        compare.value("draw " + x.name, x.counters, y.counters);
    });
    return compare.take();
}

} // namespace support
