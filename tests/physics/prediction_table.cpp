#include "tests/physics/prediction_table.hpp"

#include "reports/toml_reader.hpp"
#include "sim/config.hpp"
#include "tests/support/paths.hpp"

#include <algorithm>
#include <array>
#include <set>

namespace physics {

namespace {

std::string filled(std::string text, const std::string& value) {
    for (std::size_t at = text.find("{}"); at != std::string::npos; at = text.find("{}", at + value.size()))
        text.replace(at, 2, value);
    return text;
}

std::vector<std::string> filled(std::vector<std::string> texts, const std::string& value) {
    for (std::string& text : texts) text = filled(text, value);
    return texts;
}

/// "r" and "back-to-front" -> "r_back_to_front": a name for expressions.
std::string name_of(const std::string& series, std::string value) {
    std::replace_if(
        value.begin(), value.end(), [](char c) { return c == '-' || c == '.'; }, '_');
    return series + "_" + value;
}

/// What the runs of a row have in common.
struct Defaults {
    std::string scene, workload, gpu, design, size;
    std::vector<std::string> workload_settings, settings;

    explicit Defaults(reports::TomlTable& row)
        : scene(row.text_or("scene", "")),
          workload(row.text_or("workload", "transparency")),
          gpu(row.text_or("gpu", "neutral")),
          design(row.text_or("design", "existing")),
          size(row.text_or("size", "64x64")),
          workload_settings(row.texts("workload_settings")),
          settings(row.texts("set")) {}
};

void set_size(PredictionRun& run, reports::TomlTable& table, const std::string& size) {
    const std::size_t x = size.find('x');
    if (x == std::string::npos) table.expected("size", "WIDTHxHEIGHT");
    run.width = static_cast<std::uint32_t>(std::stoul(size.substr(0, x)));
    run.height = static_cast<std::uint32_t>(std::stoul(size.substr(x + 1)));
}

/// One run, or with `over` one for every value, "{}" in its texts replaced by it.
void read_runs(reports::TomlTable& table, const Defaults& defaults, std::vector<PredictionRun>& runs) {
    const std::string name = table.text("name");
    std::vector<std::string> over = table.texts("over");
    const bool series = !over.empty();
    if (!series) over = {""};
    PredictionRun run;
    run.scene = table.text_or("scene", defaults.scene);
    run.workload = table.text_or("workload", defaults.workload);
    run.gpu = table.text_or("gpu", defaults.gpu);
    run.design = table.text_or("design", defaults.design);
    const std::string size = table.text_or("size", defaults.size);
    run.workload_settings = defaults.workload_settings;
    for (const std::string& setting : table.texts("workload_settings")) run.workload_settings.push_back(setting);
    run.settings = defaults.settings;
    for (const std::string& setting : table.texts("set")) run.settings.push_back(setting);
    if (run.scene.empty()) table.expected("scene", "a scene, here or for all runs of the row");
    for (const std::string& value : over) {
        PredictionRun one = run;
        one.name = series ? name_of(name, value) : name;
        one.scene = filled(run.scene, value);
        one.design = filled(run.design, value);
        one.settings = filled(run.settings, value);
        one.workload_settings = filled(run.workload_settings, value);
        set_size(one, table, filled(size, value));
        runs.push_back(std::move(one));
    }
}

Prediction read_row(reports::TomlTable& table) {
    constexpr std::array<std::string_view, 2> states{"holds", "refuted"}, efforts{"quick", "long"};
    Prediction row;
    row.id = table.text("id");
    row.claim = table.text("claim");
    row.tolerance = table.text("tolerance");
    row.status = reports::choice<Prediction::Status>(table, "status", states);
    row.effort = reports::choice<Prediction::Effort>(table, "effort", efforts);
    row.mechanism = table.text_or("mechanism", "");
    if (row.mechanism.empty() == (row.status == Prediction::Status::refuted))
        table.expected("mechanism", "the mechanism and its source if refuted, else nothing");
    row.test = table.text_or("test", "");
    const Defaults defaults(table);
    table.tables("runs", [&](reports::TomlTable& run) { read_runs(run, defaults, row.runs); });
    row.expectations = table.texts("expect");
    if (row.test.empty() && (row.runs.empty() || row.expectations.empty()))
        table.expected("expect", "runs and what is expected of them, or a test");
    if (!row.test.empty() && !(row.runs.empty() && row.expectations.empty()))
        table.expected("test", "no runs beside a test");
    std::set<std::string> names;
    for (const PredictionRun& run : row.runs)
        if (!names.insert(run.name).second) table.expected("runs", "names that differ");
    return row;
}

} // namespace

std::string Prediction::test_name() const { return "PHY_" + id + (effort == Effort::long_ ? "_Long" : ""); }

std::vector<Prediction> read_predictions() {
    std::vector<Prediction> rows;
    reports::read_toml_file(
        ropsim_test::source_dir() / "tests/physics/predictions.toml", [&](reports::TomlTable& root) {
            root.tables("prediction", [&](reports::TomlTable& table) { rows.push_back(read_row(table)); });
        });
    return rows;
}

} // namespace physics
