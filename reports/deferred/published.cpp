#include "reports/deferred/published.hpp"

#include "reports/toml_reader.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace reports {

namespace {

constexpr const char* deferred_file = "reports/published/deferred.toml";

std::vector<std::uint32_t> counts_of(TomlTable& table, std::string_view key) {
    std::vector<std::uint32_t> counts;
    for (const double value : table.numbers(key)) counts.push_back(static_cast<std::uint32_t>(value));
    if (!std::is_sorted(counts.begin(), counts.end())) table.expected(key, "numbers of lights in growing order");
    return counts;
}

DeferredColumn column_of(TomlTable& table) {
    DeferredColumn column;
    column.name = table.text("name");
    column.frame = {table.text("gpu"), table.text("method"), table.text("shadows"), table.flag_or("refraction", true),
                    static_cast<std::uint32_t>(table.number("transparent"))};
    column.lights = counts_of(table, "lights");
    for (const std::string& text : table.texts("fps")) column.fps.push_back(printed_number(text, deferred_file));
    if (column.fps.size() != column.lights.size()) table.expected("fps", "one for each number of lights");
    column.repeats = table.text_or("repeats", "");
    return column;
}

DeferredTargets targets_of(TomlTable& table) {
    return {table.text("method"), printed_number(table.text("count"), deferred_file),
            printed_number(table.text("megabytes"), deferred_file)};
}

DeferredDerived derived_of(TomlTable& table) {
    DeferredDerived derived;
    derived.name = table.text("name");
    derived.kind = choice<DeferredKind>(table, "kind", sim::EnumNames<DeferredKind>::names);
    derived.a = table.text("a");
    derived.b = derived.kind == DeferredKind::slope ? "" : table.text("b");
    derived.lights = counts_of(table, "lights");
    derived.spread = table.flag_or("spread", false);
    derived.low = table.number_or("low", 0);
    derived.high = table.number_or("high", 0);
    if (!(derived.low <= derived.high)) table.expected("high", "no less than low");
    return derived;
}

} // namespace

const PrintedNumber* DeferredColumn::measured(std::uint32_t count) const {
    const auto found = std::find(lights.begin(), lights.end(), count);
    return found == lights.end() ? nullptr : &fps[static_cast<std::size_t>(found - lights.begin())];
}

DeferredFrame DeferredColumn::with(std::uint32_t count) const {
    DeferredFrame one = frame;
    one.lights = count;
    return one;
}

const DeferredColumn& PublishedDeferred::column(const std::string& name) const {
    for (const DeferredColumn& one : columns)
        if (one.name == name) return one;
    throw sim::InputError(fmt::format("{}: no column is called '{}'", deferred_file, name));
}

std::string PublishedDeferred::scene_with(std::uint32_t transparent) const {
    constexpr std::string_view place = "{transparent}";
    std::string text = scene;
    text.replace(text.find(place), place.size(), std::to_string(transparent));
    return text;
}

std::vector<std::string> PublishedDeferred::gpus() const {
    std::vector<std::string> names;
    for (const DeferredColumn& column : columns)
        if (std::find(names.begin(), names.end(), column.frame.gpu) == names.end()) names.push_back(column.frame.gpu);
    return names;
}

std::vector<std::uint32_t> PublishedDeferred::lights() const {
    std::set<std::uint32_t> all;
    for (const DeferredColumn& column : columns) all.insert(column.lights.begin(), column.lights.end());
    return {all.begin(), all.end()};
}

PublishedDeferred load_published_deferred() {
    PublishedDeferred published;
    read_data_file(deferred_file, [&](TomlTable& root) {
        published.source = root.text("source");
        published.scene = root.text("scene");
        if (published.scene.find("{transparent}") == std::string::npos)
            root.expected("scene", "a scene with {transparent} in it");
        published.width = static_cast<std::uint32_t>(root.number("width"));
        published.height = static_cast<std::uint32_t>(root.number("height"));
        published.map_size = static_cast<std::uint32_t>(root.number("map_size"));
        root.tables("targets", [&](TomlTable& table) { published.targets.push_back(targets_of(table)); });
        root.tables("columns", [&](TomlTable& table) { published.columns.push_back(column_of(table)); });
        root.tables("derived", [&](TomlTable& table) { published.derived.push_back(derived_of(table)); });
        root.tables("calibrated", [&](TomlTable& table) {
            published.calibrated = {table.text("column"), table.text("parameter"),
                                    static_cast<std::uint32_t>(table.number("lights"))};
            table.text("reason");
        });
        root.tables("explanations", [&](TomlTable& table) {
            published.explanations.push_back({table.texts("rows"), table.text("text")});
        });
    });
    for (const DeferredDerived& one : published.derived) { // every name is that of a column
        published.column(one.a);
        if (!one.b.empty()) published.column(one.b);
    }
    return published;
}

} // namespace reports
