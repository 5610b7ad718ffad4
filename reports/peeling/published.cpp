#include "reports/peeling/published.hpp"

#include "reports/toml_reader.hpp"
#include "sim/check.hpp"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace reports {

namespace {

constexpr const char* peeling_file = "reports/published/peeling.toml";
constexpr std::uint64_t triangles_per_box = 12;

PeelingDataset dataset_of(TomlTable& table) {
    PeelingDataset dataset;
    dataset.name = table.text("name");
    dataset.triangles = static_cast<std::uint64_t>(table.number("triangles"));
    dataset.scene = table.text("scene");
    dataset.eye = table.text("eye");
    dataset.target = table.text("target");
    dataset.fovy = table.number("fovy");
    dataset.grows = choice<MeshGrowth>(table, "grows", sim::EnumNames<MeshGrowth>::names);
    for (const double size : table.numbers("sizes")) dataset.sizes.push_back(static_cast<std::uint64_t>(size));
    if (dataset.sizes.size() < 2) table.expected("sizes", "at least two numbers");
    dataset.detailed = table.flag_or("detailed", false);
    return dataset;
}

PeelingMeasurement measurement_of(TomlTable& table) {
    PeelingMeasurement row;
    row.dataset = table.text("dataset");
    row.buffer = table.text("buffer");
    row.k = static_cast<std::uint32_t>(table.number("k"));
    row.entry = table.text("entry");
    for (std::size_t i = 0; i < peeling_columns; ++i)
        row.fps[i] = printed_number(table.text(sim::EnumNames<PeelingColumn>::names[i]), peeling_file);
    return row;
}

PeelingNote note_of(TomlTable& table) {
    PeelingNote note;
    note.dataset = table.text("dataset");
    note.buffer = table.text("buffer");
    note.column = table.text("column");
    note.text = table.text("text");
    return note;
}

PeelingStep peeling_step_of(TomlTable& table) {
    PeelingStep step;
    step.dataset = table.text("dataset");
    step.buffer = table.text("buffer");
    step.column = choice<PeelingColumn>(table, "column", sim::EnumNames<PeelingColumn>::names);
    step.parameter = table.text("parameter");
    step.low = table.number("low");
    step.high = table.number("high");
    if (!(step.low > 0 && step.low < step.high)) table.expected("low", "a number above 0 and below high");
    step.reason = table.text("reason");
    return step;
}

std::string replaced(std::string text, std::string_view what, std::uint64_t number) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what))
        text.replace(at, what.size(), std::to_string(number));
    return text;
}

} // namespace

std::string design_of(PeelingColumn column) {
    switch (column) {
    case PeelingColumn::mp:
        return "multipass";
    case PeelingColumn::sp:
        return "existing";
    case PeelingColumn::spwh:
        break;
    }
    return "sorted-batched";
}

std::string PeelingDataset::scene_of(std::uint64_t size) const {
    return replaced(replaced(scene, "{triangles}", size), "{boxes}", size / triangles_per_box);
}

// The picture of a surface shrinks by a wider angle, which leaves the perspective as it is.
std::string PeelingDataset::camera_of(std::uint64_t size) const {
    double angle = fovy;
    if (grows == MeshGrowth::surface) {
        constexpr double degree = std::numbers::pi / 180;
        const double shrinks = std::sqrt(static_cast<double>(triangles) / static_cast<double>(size));
        angle = 2 * std::atan(std::tan(fovy * degree / 2) * shrinks) / degree;
    }
    return fmt::format("{},{},{:.9g}", eye, target, angle);
}

const PeelingDataset& PublishedPeeling::dataset(const std::string& name) const {
    for (const PeelingDataset& one : datasets)
        if (one.name == name) return one;
    throw sim::InputError(fmt::format("{}: no dataset is called '{}'", peeling_file, name));
}

const PeelingMeasurement& PublishedPeeling::row(const std::string& dataset, const std::string& buffer) const {
    for (const PeelingMeasurement& one : rows)
        if (one.dataset == dataset && one.buffer == buffer) return one;
    throw sim::InputError(fmt::format("{}: no row is called '{}, {}'", peeling_file, dataset, buffer));
}

PublishedPeeling load_published_peeling() {
    PublishedPeeling published;
    read_data_file(peeling_file, [&](TomlTable& root) {
        published.source = root.text("source");
        published.gpu = root.text("gpu");
        root.tables("datasets", [&](TomlTable& table) { published.datasets.push_back(dataset_of(table)); });
        root.tables("rows", [&](TomlTable& table) { published.rows.push_back(measurement_of(table)); });
        root.tables("calibrated", [&](TomlTable& table) { published.calibrated.push_back(peeling_step_of(table)); });
        root.tables("repeats", [&](TomlTable& table) { published.repeats.push_back(note_of(table)); });
        root.tables("explanations", [&](TomlTable& table) { published.explanations.push_back(note_of(table)); });
    });
    published.choices = load_choices("peeling");
    return published;
}

} // namespace reports
