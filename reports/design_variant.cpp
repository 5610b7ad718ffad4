#include "reports/design_variant.hpp"

#include "models/kbuffers/library.hpp"
#include "pipeline/gpu_params.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <set>

namespace reports {

namespace {

bool is_gpu_section(std::string_view name) {
    const auto& names = sim::field_names<pipeline::GpuParams>;
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_design(std::string_view name) {
    const auto& list = models::designs();
    return std::any_of(list.begin(), list.end(), [name](const auto& info) { return info.id == name; });
}

// Where the configuration keeps a variant's key.
std::string variant_path(const DesignVariant& variant, const std::string& key) {
    const std::string first = key.substr(0, key.find('.'));
    const bool sectioned = first.size() < key.size();
    if (first == "scene" || first == "workload")
        throw sim::InputError(fmt::format("design '{}': '{}' is of the frame, which all designs of a comparison share",
                                          variant.text, key));
    if (sectioned && (is_gpu_section(first) || first == variant.design)) return key;
    if (sectioned && is_design(first))
        throw sim::InputError(
            fmt::format("design '{}': '{}' is of another design, and would change nothing", variant.text, key));
    return variant.design + "." + key;
}

void add_setting(DesignVariant& variant, std::string_view assignment) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string_view::npos || equals == 0)
        throw sim::InputError(
            fmt::format("design '{}': expected DESIGN?KEY=VALUE&KEY=VALUE, got '{}'", variant.text, assignment));
    std::string path = variant_path(variant, std::string(assignment.substr(0, equals)));
    const auto same = [&path](const auto& setting) { return setting.first == path; };
    if (std::any_of(variant.settings.begin(), variant.settings.end(), same))
        throw sim::InputError(fmt::format("design '{}': '{}' is set twice", variant.text, path));
    variant.settings.emplace_back(std::move(path), assignment.substr(equals + 1));
}

// A word says what it is about; a number and a truth value do not.
bool says_enough(const std::string& value) {
    return value != "true" && value != "false" && value.find_first_not_of("0123456789.+-e") != std::string::npos;
}

} // namespace

std::string DesignVariant::canonical() const {
    auto sorted = settings;
    std::sort(sorted.begin(), sorted.end());
    std::string result = design;
    for (const auto& [path, value] : sorted) result += fmt::format("&{}={}", path, value);
    return result;
}

std::string DesignVariant::label() const {
    std::string result = design;
    for (const auto& [path, value] : settings) {
        const std::string own = design + ".";
        const std::string key = path.starts_with(own) ? path.substr(own.size()) : path;
        result += says_enough(value) ? " " + value : fmt::format(" {}={}", key, value);
    }
    return result;
}

void DesignVariant::replace(const std::string& path, const std::string& value) {
    for (auto& [own, old] : settings) {
        if (own != path) continue;
        const std::string before = fmt::format("{}={}", path, old);
        text.replace(text.find(before), before.size(), fmt::format("{}={}", path, value));
        old = value;
    }
}

DesignVariant parse_variant(std::string_view text) {
    DesignVariant variant;
    variant.text = text;
    const std::size_t question = text.find('?');
    variant.design = text.substr(0, question);
    for (std::size_t begin = question; begin < text.size();) {
        const std::size_t end = std::min(text.find('&', ++begin), text.size());
        add_setting(variant, text.substr(begin, end - begin));
        begin = end;
    }
    return variant;
}

std::vector<std::string> split_variants(std::string_view list, std::string_view option) {
    std::vector<std::string> parts(1);
    int depth = 0;
    for (const char letter : list) {
        depth += letter == '[' ? 1 : letter == ']' ? -1 : 0;
        if (letter == ',' && depth <= 0)
            parts.emplace_back();
        else
            parts.back() += letter;
    }
    if (std::any_of(parts.begin(), parts.end(), [](const std::string& part) { return part.empty(); }))
        throw sim::InputError(fmt::format("{}: expected designs separated by commas, got '{}'", option, list));
    return parts;
}

std::vector<std::string> variant_names(const std::vector<DesignVariant>& variants) {
    std::set<std::string> seen;
    std::map<std::string, std::size_t> uses, numbers;
    for (const DesignVariant& variant : variants) {
        if (!seen.insert(variant.canonical()).second)
            throw sim::InputError(fmt::format("--designs: '{}' is named twice", variant.text));
        ++uses[variant.design];
    }
    std::vector<std::string> names;
    for (const DesignVariant& variant : variants) {
        const bool plain = uses[variant.design] == 1 && variant.settings.empty();
        names.push_back(plain ? variant.design : fmt::format("{}-{}", variant.design, ++numbers[variant.design]));
    }
    return names;
}

} // namespace reports
