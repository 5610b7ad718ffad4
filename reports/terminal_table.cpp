#include "reports/terminal_table.hpp"

#include "reports/left_out.hpp"
#include "reports/numbers.hpp"
#include "reports/run_numbers.hpp"
#include "reports/wrong_text.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports {

using pipeline::RunResult;

namespace {

enum class Emphasis : std::uint8_t { none, bad, good };

struct Cell {
    std::string text;
    Emphasis emphasis = Emphasis::none;
};
using Row = std::vector<Cell>;

struct Column {
    const char* title;
    const char* unit;
};
constexpr std::array<Column, 12> columns{{{"design", ""},
                                          {"cycles", ""},
                                          {"time", "ms"},
                                          {"speed", "x"},
                                          {"fragm.", ""},
                                          {"concurrency", "hazards"},
                                          {"incoherence", "hazards"},
                                          {"wrong", "px"},
                                          {"DRAM", "B/frag"},
                                          {"on chip", "KiB"},
                                          {"host", "cyc/s"},
                                          {"CPU", "cyc/s"}}};

std::string paint(std::string text, const char* code, bool colour) {
    return colour ? fmt::format("\033[{}m{}\033[0m", code, text) : text;
}

std::string count_text(std::uint64_t number, bool exact) {
    return exact ? with_commas(number) : short_number(static_cast<double>(number));
}

Cell count_cell(std::uint64_t number, bool exact) { return {count_text(number, exact)}; }

Cell error_cell(std::uint64_t number, bool exact) {
    return {count_text(number, exact), number > 0 ? Emphasis::bad : Emphasis::none};
}

std::string optional_text(std::optional<double> number) { return number ? fmt::format("{:.1f}", *number) : "-"; }

// Of a design that another one was run for there is none.
std::string rate_text(double rate) { return rate > 0 ? short_number(rate) : "-"; }

Row row_of(const RunResult& run, const std::string& name, const RunResult& base, bool exact) {
    const pipeline::HazardCounts& hazards = run.hazards;
    const double relative = run.cycles > 0 && base.cycles > 0 ? milliseconds(base) / milliseconds(run) : 0.0;
    const auto area = on_chip_bytes(run);
    return {{name},
            count_cell(run.cycles, exact),
            {fmt::format("{:.{}f}", milliseconds(run), milliseconds(run) < 99.95 ? 3 : 1)},
            {fmt::format("{:.2f}", relative)},
            count_cell(run.fragments, exact),
            error_cell(hazards.of(pipeline::HazardKind::concurrency), exact),
            error_cell(hazards.of(pipeline::HazardKind::incoherence), exact),
            {count_text(run.wrong_pixels, exact), run.wrong_pixels > 0 ? Emphasis::bad : Emphasis::good},
            {optional_text(bytes_per_fragment(run, "dram"))},
            {optional_text(area ? std::optional(*area / 1024) : std::nullopt)},
            {rate_text(cycles_per_second(run))},
            {rate_text(cycles_per_cpu_second(run))}};
}

using Widths = std::array<std::size_t, columns.size()>;

Widths widths_of(const std::vector<Row>& rows) {
    Widths widths{};
    for (std::size_t i = 0; i < columns.size(); ++i) {
        widths[i] = std::max(std::string_view(columns[i].title).size(), std::string_view(columns[i].unit).size());
        for (const Row& row : rows) widths[i] = std::max(widths[i], row[i].text.size());
    }
    return widths;
}

std::size_t total(const Widths& widths) {
    std::size_t sum = 2 * (widths.size() - 1);
    for (const std::size_t width : widths) sum += width;
    return sum;
}

// The first column is text, the others are numbers.
std::string padded(const std::string& text, std::size_t width, std::size_t column) {
    return column == 0 ? fmt::format("{:<{}}", text, width) : fmt::format("  {:>{}}", text, width);
}

using Block = std::vector<std::size_t>; ///< numbers of the columns that stand side by side

std::string line_of(const Row& row, const Widths& widths, const Block& block, bool colour) {
    std::string line;
    for (const std::size_t i : block) {
        const std::string text = padded(row[i].text, widths[i], i);
        line += row[i].emphasis == Emphasis::none ? text
                                                  : paint(text, row[i].emphasis == Emphasis::bad ? "31" : "32", colour);
    }
    return line + "\n";
}

std::string without_trailing_blanks(std::string line) {
    line.erase(line.find_last_not_of(' ') + 1);
    return line;
}

std::string header_of(const Widths& widths, const Block& block, bool colour) {
    std::string titles, units;
    for (const std::size_t i : block) {
        titles += padded(columns[i].title, widths[i], i);
        units += padded(columns[i].unit, widths[i], i);
    }
    return paint(without_trailing_blanks(titles), "1", colour) + "\n" + without_trailing_blanks(units) + "\n";
}

std::vector<Row> rows_of(const Comparison& comparison, bool labels, bool exact) {
    std::vector<Row> rows;
    const RunResult& base = comparison.runs.at(comparison.base_run());
    for (std::size_t i = 0; i < comparison.runs.size(); ++i)
        rows.push_back(row_of(comparison.runs[i], labels ? comparison.variants.at(i).label : comparison.runs[i].design,
                              base, exact));
    return rows;
}

std::string base_text(const Comparison& comparison, bool labels) {
    if (comparison.runs.size() < 2) return "";
    const std::size_t base = comparison.base_run();
    return fmt::format("speed: times that of {}\n",
                       labels ? comparison.variants.at(base).label : comparison.runs[base].design);
}

std::string caches_text(const RunResult& run) {
    std::string text;
    for (const auto& cache : run.area->at("tile_caches").items())
        if (const auto bytes = cache.value().get<std::uint64_t>(); bytes != 0)
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", cache.key(), with_commas(bytes));
    return text;
}

// A row for each design that does not fit, and what the tile caches of the others got.
std::string equal_area_text(const Comparison& comparison, TerminalStyle style) {
    if (!comparison.equal_area) return "";
    std::string text;
    for (const EqualArea::Unfit& unfit : comparison.equal_area->does_not_fit)
        text +=
            paint(fmt::format("{}  does not fit: needs {}\n", unfit.variant.label, sim::counted(unfit.needed, "byte")),
                  "31", style.colour);
    text +=
        fmt::format("equal area: {} on chip; tile caches got\n", sim::counted(comparison.equal_area->bytes, "byte"));
    for (std::size_t i = 0; i < comparison.runs.size(); ++i)
        text += fmt::format("  {}: {} bytes\n", comparison.variants.at(i).label, caches_text(comparison.runs[i]));
    return text;
}

std::string variants_text(const Comparison& comparison, TerminalStyle style) {
    std::string text;
    for (std::size_t i = 0; i < comparison.runs.size(); ++i)
        if (comparison.runs[i].design != comparison.variants.at(i).text)
            text += reports::wrap(fmt::format("{}: {}", comparison.runs[i].design, comparison.variants[i].text),
                                  style.columns, 2);
    return text;
}

} // namespace

std::string wrap(const std::string& text, std::size_t columns_allowed, std::size_t indent) {
    constexpr std::size_t usual_indent = 4;
    if (indent > columns_allowed / 2) indent = usual_indent; // words need room, too
    std::string result, line;
    bool blank = false; // before the next word
    for (std::size_t begin = 0; begin < text.size();) {
        std::size_t end = std::min(text.find(' ', begin), text.size());
        if (end - begin + indent > columns_allowed) // "design?key=value&key=value" may end a line behind each setting
            if (const std::size_t setting = text.find('&', begin); setting < end) end = setting + 1;
        const std::string word = text.substr(begin, end - begin);
        const bool is_begun = line.find_first_not_of(' ') != std::string::npos;
        if (is_begun && line.size() + (blank ? 1 : 0) + word.size() > columns_allowed) {
            result += without_trailing_blanks(line) + "\n";
            line = std::string(indent, ' ') + word;
        } else {
            line += (blank ? " " : "") + word;
        }
        blank = end < text.size() && text[end] == ' ';
        begin = end + (blank ? 1 : 0);
    }
    return result + without_trailing_blanks(line) + "\n";
}

std::string heading(const Comparison& comparison, TerminalStyle style) {
    std::string method = comparison.frame->workload;
    if (const auto& program = comparison.frame->program)
        method += fmt::format(" ({}, k = {}, {} B per pixel)", program->id(), program->k(), program->bytes_per_pixel());
    std::string overflow;
    if (const std::uint64_t pixels = overflow_pixels(comparison); pixels > 0)
        overflow =
            fmt::format("; {} more than k fragments", sim::counted(pixels, "pixel") + (pixels == 1 ? " has" : " have"));
    const std::string text =
        fmt::format("{}: {} drawn at {} x {}{}; {}{}; GPU {}; seed {}", comparison.scene.name,
                    sim::counted(comparison.scene.triangles_drawn, "triangle"), comparison.width(), comparison.height(),
                    samples_text(comparison), method, overflow, comparison.gpu.name, comparison.seed);
    return wrap(text, style.columns, 2);
}

std::string designs_text(const Comparison& comparison, TerminalStyle style) {
    // The fullest form that fits: whole numbers before short ones, and the names of folders only where nothing else
    // has room.
    struct Form {
        bool labels, exact;
    };
    std::vector<Row> rows;
    Widths widths{};
    bool labels = true;
    for (const Form form : {Form{true, true}, Form{true, false}, Form{false, false}}) {
        rows = rows_of(comparison, form.labels, form.exact);
        widths = widths_of(rows);
        labels = form.labels;
        if (total(widths) <= style.columns) break;
    }
    std::string text;
    for (const Block& block : folded({widths.begin(), widths.end()}, style)) {
        text += (text.empty() ? "" : "\n") + header_of(widths, block, style.colour);
        for (const Row& row : rows) text += line_of(row, widths, block, style.colour);
    }
    for (const std::string& line : wrong_lines(comparison)) text += wrap(line, style.columns, 2);
    return text + equal_area_text(comparison, style) + base_text(comparison, labels) +
           (labels ? "" : variants_text(comparison, style));
}

std::string left_out_text(const Comparison& comparison, TerminalStyle style) {
    const auto entries = left_out_entries(comparison);
    std::string text = entries.empty() ? "Nothing was left out.\n" : "Left out:\n";
    std::size_t widest = 0;
    for (const LeftOutEntry& entry : entries) widest = std::max(widest, entry.unit.size());
    for (const LeftOutEntry& entry : entries) {
        const std::string who = entry.by_all ? "" : fmt::format("{}: ", fmt::join(entry.designs, ", "));
        text += wrap(fmt::format("  {:<{}}  {}{}", entry.unit, widest, who, entry.reason), style.columns, widest + 4);
    }
    return text;
}

} // namespace reports
