#include "reports/csv.hpp"

#include "reports/counter_rows.hpp"
#include "reports/flatten.hpp"
#include "reports/hazard_text.hpp"
#include "reports/run_numbers.hpp"
#include "reports/wrong_text.hpp"
#include "sim/described.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unordered_map>

namespace reports {

using nlohmann::ordered_json;
using pipeline::RunResult;

namespace {

std::string text(std::uint64_t number) { return std::to_string(number); }
std::string text(double number) { return sim::number_text(number); }

// Rows whose columns become known while they are added: the union of all names, in the order of first appearance.
class WideTable {
  public:
    explicit WideTable(std::vector<std::string> key_columns) : columns_(std::move(key_columns)) {}

    void add_row(std::vector<std::string> keys, const FlatValues& values) {
        keys.resize(columns_.size());
        for (const auto& [name, value] : values) {
            const auto [known, is_new] = index_.try_emplace(name, columns_.size());
            if (is_new) columns_.push_back(name);
            if (keys.size() <= known->second) keys.resize(known->second + 1);
            keys[known->second] = cell_text(value);
        }
        rows_.push_back(std::move(keys));
    }

    Table finish(std::string name) {
        for (auto& row : rows_) row.resize(columns_.size());
        return {std::move(name), std::move(columns_), std::move(rows_)};
    }

  private:
    std::vector<std::string> columns_;
    std::unordered_map<std::string, std::size_t> index_;
    std::vector<std::vector<std::string>> rows_;
};

// Numbers that every design has; the columns of caches, bytes and area follow them.
const std::vector<std::string>& design_columns() {
    static const std::vector<std::string> columns = [] {
        std::vector<std::string> list{"design",           "variant",   "cycles [core cycles]",
                                      "core clock [MHz]", "time [ms]", "frames per second [1/s]",
                                      "fragments"};
        for (const auto name : hazard_class_names) list.push_back(fmt::format("{} [fragments]", name));
        list.emplace_back("hazards [fragments]");
        for (const auto name : hazard_kind_names) list.push_back(fmt::format("{} [fragments]", name));
        for_each_hazard_cell({}, [&list](const std::string& name, std::uint64_t) {
            list.push_back(fmt::format("{} [fragments]", name));
        });
        list.insert(list.end(),
                    {"hazard pixels [pixels]", "hazards per million [1e-6]", "concurrency per million [1e-6]",
                     "incoherence per million [1e-6]", "mean staleness [versions]", "max staleness [versions]",
                     "wrong pixels [pixels]", "tied pixels [pixels]", "overflow pixels [pixels]",
                     "unexplained pixels [pixels]", "lost fragments [fragments]", "lost updates [fragments]"});
        for_each_reason({}, [&list](std::string_view reason, std::string_view, std::uint64_t) {
            list.push_back(fmt::format("wrong because {} [pixels]", reason));
        });
        return list;
    }();
    return columns;
}

std::vector<std::string> hazard_cells(const RunResult& run) {
    const pipeline::HazardCounts& hazards = run.hazards;
    std::vector<std::string> cells;
    for (std::size_t cause = 0; cause < pipeline::hazard_classes; ++cause)
        cells.push_back(text(hazards.of(static_cast<pipeline::HazardClass>(cause))));
    cells.push_back(text(hazards.total()));
    for (const auto kind : {pipeline::HazardKind::concurrency, pipeline::HazardKind::incoherence})
        cells.push_back(text(hazards.of(kind)));
    for_each_hazard_cell(hazards, [&cells](const std::string&, std::uint64_t count) { cells.push_back(text(count)); });
    cells.insert(cells.end(), {text(hazards.pixels), text(hazards_per_million(run)),
                               text(hazards_per_million(run, pipeline::HazardKind::concurrency)),
                               text(hazards_per_million(run, pipeline::HazardKind::incoherence)),
                               text(run.mean_staleness), text(run.max_staleness)});
    return cells;
}

std::vector<std::string> design_cells(const RunResult& run, const VariantFacts& variant) {
    std::vector<std::string> cells{run.design,
                                   variant.text,
                                   text(run.cycles),
                                   text(run.core_mhz),
                                   text(milliseconds(run)),
                                   text(frames_per_second(run)),
                                   text(run.fragments)};
    const std::vector<std::string> hazards = hazard_cells(run);
    cells.insert(cells.end(), hazards.begin(), hazards.end());
    for (const std::uint64_t count : {run.wrong_pixels, run.tied_pixels, run.overflow_pixels, run.unexplained_pixels(),
                                      run.lost_fragments, run.lost_updates})
        cells.push_back(text(count));
    for_each_reason(run.wrong_because, [&cells](std::string_view, std::string_view, std::uint64_t count) {
        cells.push_back(text(count));
    });
    return cells;
}

} // namespace

std::string Table::text() const {
    std::string result = sim::csv_line(header);
    for (const auto& row : rows) result += sim::csv_line(row);
    return result + lines;
}

Table designs_table(const Comparison& comparison) {
    WideTable table(design_columns());
    for (std::size_t i = 0; i < comparison.runs.size(); ++i) {
        const RunResult& run = comparison.runs[i];
        ordered_json further;
        for (std::size_t layer = 0; layer < run.layers.size(); ++layer)
            further["layer" + std::to_string(layer)] = {{"missing", run.layers[layer].missing},
                                                        {"duplicate", run.layers[layer].duplicate},
                                                        {"unsorted", run.layers[layer].unsorted}};
        further["caches"] = run.caches;
        further["bytes"] = run.bytes;
        further["area"] = run.area;
        table.add_row(design_cells(run, comparison.variants.at(i)), flatten(further));
    }
    if (comparison.equal_area)
        for (const EqualArea::Unfit& unfit : comparison.equal_area->does_not_fit)
            table.add_row({unfit.name, unfit.variant.text},
                          flatten({{"does_not_fit", {{"needed_bytes", unfit.needed}}}}));
    return table.finish("designs.csv");
}

Table stages_table(const Comparison& comparison) {
    Table table{"stages.csv", {"design", "stage", "kind", "name", "value", "unit"}, {}};
    for (const RunResult& run : comparison.runs)
        for (const CounterRow& row : counter_rows(run))
            table.rows.push_back({run.design, row.stage, row.kind, row.name, row.value, row.unit});
    return table;
}

namespace {

// Rows of draws, written down at once: there may be millions of them. add(run, line) calls line(keys, counters).
template <class Add>
Table table_of_draws(std::string name, std::vector<std::string> keys, const Comparison& comparison, Add add) {
    Table table{std::move(name), std::move(keys), {}, {}};
    const auto first = static_cast<std::ptrdiff_t>(table.header.size());
    for (const RunResult& run : comparison.runs)
        for (const std::string& counter : run.draw_counters)
            if (std::find(table.header.begin(), table.header.end(), counter) == table.header.end())
                table.header.push_back(counter);
    std::vector<std::string> row(table.header.size());
    for (const RunResult& run : comparison.runs) {
        std::vector<std::size_t> column;
        for (const std::string& counter : run.draw_counters)
            column.push_back(static_cast<std::size_t>(
                std::find(table.header.begin() + first, table.header.end(), counter) - table.header.begin()));
        std::fill(row.begin(), row.end(), "");
        add(run, [&](std::initializer_list<std::string> key, const std::vector<std::uint64_t>& counters) {
            std::copy(key.begin(), key.end(), row.begin());
            for (std::size_t i = 0; i < counters.size(); ++i) row[column[i]] = text(counters[i]);
            table.lines += sim::csv_line(row);
        });
    }
    return table;
}

} // namespace

Table draws_table(const Comparison& comparison) {
    return table_of_draws("draws.csv", {"design", "draw", "name"}, comparison, [](const RunResult& run, auto line) {
        for (const pipeline::DrawResult& draw : run.draws)
            line({run.design, text(std::uint64_t{draw.draw}), draw.name}, draw.counters);
    });
}

Table pass_draws_table(const Comparison& comparison) {
    return table_of_draws("pass_draws.csv", {"design", "pass", "pass name", "draw", "name"}, comparison,
                          [](const RunResult& run, auto line) {
                              for (const pipeline::PassDrawResult& draw : run.pass_draws)
                                  line({run.design, text(std::uint64_t{draw.pass}), run.passes.at(draw.pass).name,
                                        text(std::uint64_t{draw.draw}), run.draws.at(draw.draw).name},
                                       draw.counters);
                          });
}

Table passes_table(const Comparison& comparison) {
    WideTable table({"design", "pass", "name", "first cycle [core cycles]", "cycles [core cycles]"});
    for (const RunResult& run : comparison.runs)
        for (std::size_t i = 0; i < run.passes.size(); ++i) {
            const pipeline::PassResult& pass = run.passes[i];
            table.add_row({run.design, text(std::uint64_t{i}), pass.name, text(pass.first_cycle), text(pass.cycles)},
                          flatten(pass.counters));
        }
    return table.finish("passes.csv");
}

Table hazard_pairs_table(const Comparison& comparison) {
    Table table{"hazard_pairs.csv",
                {"design", "number", "listed", "hazards", "class", "kind", "x [pixels]", "y [pixels]", "victim [quad]",
                 "aggressor [quad]", "missing [versions]", "read [core cycle]", "write [core cycle]"},
                {}};
    for (const RunResult& run : comparison.runs)
        for (std::size_t i = 0; i < run.pairs.size(); ++i) {
            const pipeline::HazardPair& pair = run.pairs[i];
            table.rows.push_back({run.design, text(std::uint64_t{i + 1}), text(std::uint64_t{run.pairs.size()}),
                                  text(run.hazards.total()), std::string(hazard_name(pair.cause)),
                                  std::string(hazard_name(pair.kind)), text(std::uint64_t{pair.x}),
                                  text(std::uint64_t{pair.y}), text(std::uint64_t{pair.victim}),
                                  text(std::uint64_t{pair.aggressor}), text(std::uint64_t{pair.missing}),
                                  text(pair.read), text(pair.write)});
        }
    return table;
}

Table hazard_distance_table(const Comparison& comparison) {
    Table table{"hazard_distance.csv", {"design", "from [quads]", "below [quads]", "hazards [fragments]"}, {}};
    for (const RunResult& run : comparison.runs)
        for (std::size_t bin = 0; bin < run.hazard_distance.size(); ++bin)
            table.rows.push_back({run.design, text(std::uint64_t{1} << bin), text(std::uint64_t{2} << bin),
                                  text(run.hazard_distance[bin])});
    return table;
}

std::vector<Table> all_tables(const Comparison& comparison) {
    return {designs_table(comparison),        stages_table(comparison), draws_table(comparison),
            pass_draws_table(comparison),     passes_table(comparison), hazard_pairs_table(comparison),
            hazard_distance_table(comparison)};
}

} // namespace reports
