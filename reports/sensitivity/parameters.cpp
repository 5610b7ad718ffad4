#include "reports/sensitivity/parameters.hpp"

#include "reports/flatten.hpp"
#include "sim/check.hpp"
#include "sim/described_json.hpp"
#include "sim/suggest.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace reports {

namespace {

struct Bounds {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

std::optional<double> number_in(std::string_view text) {
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

// "1 to 64", "at least 1", "at most 8".
Bounds bounds_of(const std::string& range) {
    constexpr std::string_view between = " to ", least = "at least ", most = "at most ";
    Bounds bounds;
    if (range.starts_with(least)) bounds.low = number_in(range.substr(least.size())).value_or(bounds.low);
    if (range.starts_with(most)) bounds.high = number_in(range.substr(most.size())).value_or(bounds.high);
    if (const std::size_t at = range.find(between); at != std::string::npos) {
        bounds.low = number_in(range.substr(0, at)).value_or(bounds.low);
        bounds.high = number_in(range.substr(at + between.size())).value_or(bounds.high);
    }
    return bounds;
}

std::vector<std::string> choices_of(const std::string& range) {
    constexpr std::string_view separator = " | ";
    std::vector<std::string> list;
    for (std::size_t begin = 0; begin <= range.size();) {
        const std::size_t end = std::min(range.find(separator, begin), range.size());
        list.push_back(range.substr(begin, end - begin));
        begin = end + separator.size();
    }
    return list;
}

void add_number(std::vector<SensitivityStep>& steps, const sim::FieldInfo& field, const std::string& from, double to,
                Direction direction) {
    const Bounds bounds = bounds_of(field.range);
    double value = std::clamp(to, bounds.low, bounds.high);
    if (field.type == "whole number") value = std::round(value);
    std::string text = field.type == "whole number" ? fmt::format("{:.0f}", value) : sim::number_text(value);
    if (number_in(text) != number_in(from)) steps.push_back({std::move(text), direction, {}, {}});
}

/// What must have been built for a parameter to be read; the first prefix that fits counts. An empty list: nothing
/// reads it here.
struct Reader {
    std::string_view prefix;
    std::vector<std::string_view> units;
    std::string_view reason;
};

const std::vector<Reader>& readers() {
    static const std::vector<Reader> list{
        {"host.immediate_ns", {}, "vertices come from buffers"},
        {"host.list_ns", {}, "vertices come from buffers"},
        {"host.client_gbps", {}, "vertices come from buffers"},
        {"geometry.index_fetch", {"index fetch"}, "no draw is indexed"},
        {"early_depth", {"early depth test"}, "no early depth test is built"},
        {"texture", {"texture path to memory", "k-buffer read path of the shaders"}, "nothing reads textures"},
        {"rop.depth_cache_bytes", {"depth tile cache"}, "no depth tile cache is built"},
        {"rop.colour_cache_bytes", {"colour tile cache"}, "no colour tile cache is built"},
        {"rop.kbuffer_cache_bytes",
         {"k-buffer surface and its tile cache", "lists of fragments"},
         "no k-buffer tile cache is built"},
        {"rop.fp16_overflow", {}, "it changes the picture, and no time"},
        {"rop.reads_per_clk", {"k-buffer read path of the shaders"}, "no shader reads the k-buffer"},
        {"rop.read_", {"k-buffer read path of the shaders"}, "no shader reads the k-buffer"},
    };
    return list;
}

// Formats that no drawn vertex has are not converted.
bool converts(const pipeline::Frame& frame, const std::string& path) {
    const auto& names = sim::field_names<pipeline::ConversionParams>;
    for (const pipeline::Draw& draw : frame.draws)
        for (const pipeline::VertexAttribute& attribute : frame.resources->geometries[draw.geometry].attributes) {
            const auto slot = names.at(static_cast<std::size_t>(pipeline::slot_of(attribute.semantic)));
            pipeline::SlotConversion marked; // one nanosecond at the format's own place
            bool found = false;
            sim::for_each_field(marked, [&](const auto& field, double& ns) {
                if (path != fmt::format("host.convert.{}.{}", slot, field.name)) return;
                ns = 1;
                found = marked.ns(attribute.type) > 0;
            });
            if (found) return true;
        }
    return false;
}

std::string why_not_read(const ComparisonInput& input, const std::vector<std::string>& built, const std::string& path) {
    if (path.starts_with("host.convert.") && !converts(*input.frame, path)) return "no drawn vertex has such a format";
    for (const Reader& reader : readers()) {
        if (!path.starts_with(reader.prefix)) continue;
        const auto is_built = [&built](std::string_view unit) {
            return std::find(built.begin(), built.end(), unit) != built.end();
        };
        return std::any_of(reader.units.begin(), reader.units.end(), is_built) ? "" : std::string(reader.reason);
    }
    return "";
}

struct KnownParameter {
    sim::FieldInfo field;
    std::string value;
};

// Of the GPU and of the compared designs, in the order of their description.
std::vector<KnownParameter> known_parameters(const ComparisonInput& input) {
    std::vector<KnownParameter> list;
    std::map<std::string, std::string> values;
    for (const auto& [path, value] : flatten(input.gpu.parameters)) values[path] = cell_text(value);
    std::vector<sim::FieldInfo> fields = sim::describe<pipeline::GpuParams>();
    std::set<std::string> seen;
    for (const ComparedDesign& row : input.designs) {
        if (!seen.insert(row.variant.design).second) continue;
        for (const auto& [path, value] : flatten(sim::to_json(row.design->parameters())))
            values[fmt::format("{}.{}", row.variant.design, path)] = cell_text(value);
        for (const models::DesignInfo& info : models::designs())
            if (info.id == row.variant.design)
                for (sim::FieldInfo& field : info.parameters()) fields.push_back(std::move(field));
    }
    for (sim::FieldInfo& field : fields)
        if (const auto found = values.find(field.path); found != values.end())
            list.push_back({std::move(field), found->second});
    return list;
}

bool lies_below(const std::string& path, const std::string& section) {
    return path == section || path.starts_with(section + ".");
}

void expect_known(const std::vector<std::string>& asked, const std::vector<KnownParameter>& known) {
    std::vector<std::string> paths;
    for (const KnownParameter& one : known) paths.push_back(one.field.path);
    for (const std::string& name : asked)
        if (std::none_of(paths.begin(), paths.end(), [&](const std::string& path) { return lies_below(path, name); }))
            throw sim::InputError(fmt::format("--parameters: neither the GPU nor a compared design has '{}'{}", name,
                                              sim::did_you_mean(name, paths)));
}

// Zeros that stand for a value that follows from others are varied around that value.
std::string meant_value(const KnownParameter& one, const ComparisonInput& input) {
    if (number_in(one.value) != 0.0 || input.designs.empty()) return one.value;
    const pipeline::GpuParams& gpu = input.designs.front().gpu;
    if (one.field.path == "reorder_buffer.quads") return std::to_string(gpu.reorder_quads());
    if (one.field.path == "memory.clock_mhz") return sim::number_text(gpu.clock.core_mhz);
    return one.value;
}

// The sizes and rates of a design are assumed as those of the GPU are; its switches and rules make another design.
bool sizes_a_design(const KnownParameter& one) {
    return (one.field.type == "whole number" || one.field.type == "number") && number_in(one.value).value_or(0) != 0;
}

} // namespace

double zero_step(const std::string& unit) {
    if (unit == "us") return 10;
    if (unit.starts_with("bytes per c") || unit == "bytes/clk" || unit == "bytes/cycle") return 64;
    return 1;
}

std::vector<SensitivityStep> steps_of(const sim::FieldInfo& field, const std::string& value, double factor) {
    std::vector<SensitivityStep> steps;
    if (field.type == "true or false") {
        steps.push_back({value == "true" ? "false" : "true", Direction::other, {}, {}});
    } else if (field.type == "choice") {
        for (std::string& choice : choices_of(field.range))
            if (choice != value) steps.push_back({std::move(choice), Direction::other, {}, {}});
    } else if (const auto number = number_in(value); field.type == "whole number" || field.type == "number") {
        if (!number) return steps;
        if (*number == 0) {
            add_number(steps, field, value, zero_step(field.unit), Direction::up);
        } else {
            add_number(steps, field, value, *number / factor, Direction::down);
            add_number(steps, field, value, *number * factor, Direction::up);
        }
    }
    return steps;
}

ParameterChoice choose_parameters(const SensitivityRequest& request, const ComparisonInput& input,
                                  const std::vector<std::string>& built) {
    const std::vector<KnownParameter> known = known_parameters(input);
    expect_known(request.parameters, known);
    ParameterChoice choice;
    for (const KnownParameter& one : known) {
        const std::string& path = one.field.path;
        const auto names_it = [&path](const std::string& name) { return lies_below(path, name); };
        const bool asked = std::any_of(request.parameters.begin(), request.parameters.end(), names_it);
        if (!request.parameters.empty() && !asked) continue;
        if (request.parameters.empty()) {
            const auto origin = input.gpu.origins.find(path);
            if (origin == input.gpu.origins.end() ? !sizes_a_design(one) : origin->second.origin != "assumed") continue;
            if (std::string reason = why_not_read(input, built, path); !reason.empty()) {
                choice.skipped.emplace_back(path, std::move(reason));
                continue;
            }
        }
        SensitivityParameter parameter{path, one.value, one.field.unit, one.field.text, {}};
        parameter.steps = steps_of(one.field, meant_value(one, input), request.factor);
        if (parameter.steps.empty())
            choice.skipped.emplace_back(path, "there is no other value in its range");
        else
            choice.chosen.push_back(std::move(parameter));
    }
    return choice;
}

} // namespace reports
