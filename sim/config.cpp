#include "sim/config.hpp"

#include "sim/described_json.hpp"
#include "sim/read_file.hpp"
#include "sim/suggest.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <toml++/toml.h>

namespace sim {

using nlohmann::ordered_json;

namespace {

std::string place_of(const std::string& name, const toml::source_position& position) {
    return fmt::format("{}:{}:{}", name, position.line, position.column);
}

std::string text_of_date(const auto& node) {
    std::ostringstream text;
    text << node.get();
    return text.str();
}

ordered_json json_of(const toml::node& node) {
    if (const toml::table* table = node.as_table()) {
        ordered_json json = ordered_json::object();
        for (const auto& [key, value] : *table) json[std::string(key.str())] = json_of(value);
        return json;
    }
    if (const toml::array* array = node.as_array()) {
        ordered_json json = ordered_json::array();
        for (const toml::node& value : *array) json.push_back(json_of(value));
        return json;
    }
    if (const auto* value = node.as_integer()) return value->get();
    if (const auto* value = node.as_floating_point()) return value->get();
    if (const auto* value = node.as_boolean()) return value->get();
    if (const auto* value = node.as_string()) return value->get();
    if (const auto* value = node.as_date()) return text_of_date(*value);
    if (const auto* value = node.as_time()) return text_of_date(*value);
    return text_of_date(*node.as_date_time());
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

bool is_at_or_below(std::string_view path, std::string_view section) {
    if (section.empty() || path == section) return true;
    return path.size() > section.size() && path.starts_with(section) && path[section.size()] == '.';
}

} // namespace

// Files the nodes of a parsed text under their paths.
struct Config::Inserter {
    Config& config;
    const std::string& name;
    const std::string* raw; ///< set for the command line

    std::string place(const toml::node& node) const {
        return raw != nullptr ? name : place_of(name, node.source().begin);
    }

    void insert(const toml::node& node, const std::string& path) const {
        const toml::table* table = node.as_table();
        if (table == nullptr) {
            Leaf leaf{json_of(node), place(node), raw != nullptr ? *raw : "", {}, raw != nullptr, false};
            if (raw != nullptr) leaf.origin.origin = "command line";
            config.leaves_.insert_or_assign(path, std::move(leaf));
        } else if (table->contains("value")) {
            insert_with_origin(*table, path);
        } else {
            if (table->empty()) config.empty_tables_.insert_or_assign(path, place(node));
            for (const auto& [key, value] : *table) insert(value, detail::join_path(path, key.str()));
        }
    }

    void insert_with_origin(const toml::table& table, const std::string& path) const {
        Leaf leaf;
        leaf.place = place(table);
        leaf.has_origin = true;
        for (const auto& [key, value] : table) {
            if (key.str() == "value") {
                leaf.value = json_of(value);
                continue;
            }
            std::string* text = key.str() == "origin"   ? &leaf.origin.origin
                                : key.str() == "source" ? &leaf.origin.source
                                : key.str() == "note"   ? &leaf.origin.note
                                                        : nullptr;
            const std::string full = detail::join_path(path, key.str());
            if (text == nullptr)
                detail::unknown_key({place(value), path}, std::string(key.str()),
                                    {"value", "origin", "source", "note"});
            if (!value.is_string()) detail::expected({place(value), full}, "text", json_of(value));
            *text = value.as_string()->get();
        }
        config.leaves_.insert_or_assign(path, std::move(leaf));
    }
};

void Config::insert_toml(std::string_view text, const std::string& name, const std::string* raw) {
    const toml::table table = toml::parse(text, std::string_view(name));
    for (const auto& [key, value] : table) Inserter{*this, name, raw}.insert(value, std::string(key.str()));
}

Config Config::from_toml_text(std::string_view text, const std::string& name) {
    Config config;
    try {
        config.insert_toml(text, name, nullptr);
    } catch (const toml::parse_error& error) {
        throw InputError(fmt::format("{}: {}", place_of(name, error.source().begin), error.description()));
    }
    return config;
}

Config Config::from_toml_file(const std::filesystem::path& path) {
    constexpr std::uint64_t most_bytes = std::uint64_t{16} << 20U;
    return from_toml_text(read_file(path, most_bytes), path.string());
}

void Config::complete_from(const Config& base) {
    leaves_.insert(base.leaves_.begin(), base.leaves_.end());
    empty_tables_.insert(base.empty_tables_.begin(), base.empty_tables_.end());
}

std::string Config::take_text(const std::string& path) {
    const auto found = leaves_.find(path);
    if (found == leaves_.end()) return {};
    if (!found->second.value->is_string()) detail::expected({found->second.place, path}, "text", *found->second.value);
    std::string text = found->second.value->get<std::string>();
    leaves_.erase(found);
    return text;
}

void Config::set(std::string_view assignment, const std::string& place) {
    const std::size_t equals = assignment.find('=');
    const std::string key(trimmed(assignment.substr(0, equals)));
    const auto bad = [&] {
        return InputError(fmt::format("{}: expected SECTION.KEY=VALUE, got '{}'", place, assignment));
    };
    const bool plain_key = !key.empty() && key.find_first_of("\"'\n#[]{} \t") == std::string::npos;
    if (equals == std::string_view::npos || !plain_key) throw bad();
    const std::string value(trimmed(assignment.substr(equals + 1)));
    if (value.find('\n') != std::string::npos) throw bad();
    try {
        insert_toml(key + " = " + value, place, &value);
    } catch (const toml::parse_error&) {
        // Not a TOML value, so it is text without quotes.
        if (value.find('\'') != std::string::npos) throw bad();
        try {
            insert_toml(key + " = '" + value + "'", place, &value);
        } catch (const toml::parse_error&) {
            throw bad();
        }
    }
}

const Config::Leaf* Config::use(const std::string& path, bool is_text) {
    known_.insert(path);
    const auto found = leaves_.find(path);
    if (found == leaves_.end()) return nullptr;
    Leaf& leaf = found->second;
    leaf.used = true;
    if (is_text && !leaf.raw.empty() && !leaf.value->is_string()) *leaf.value = leaf.raw;
    return &leaf;
}

void Config::expect_table(const std::string& path) const {
    if (const auto found = leaves_.find(path); found != leaves_.end())
        detail::expected({found->second.place, path}, "a table", *found->second.value);
}

void Config::read_table(std::string_view section, const StructTable& table, void* object) {
    sections_.emplace(section);
    read_fields(std::string(section), table, object);
}

void Config::read_fields(const std::string& section, const StructTable& table, void* object) {
    expect_table(section);
    for (const FieldRow& field : table.fields) {
        const Kind kind = field.type->kind;
        const std::string path = detail::join_path(section, field.name);
        void* member = member_at(field, object);
        if (kind == Kind::table)
            read_fields(path, *field.type->table, member);
        else if (const Leaf* leaf = use(path, kind == Kind::text || kind == Kind::choice))
            detail::read_member(field, member, *leaf->value, {leaf->place, path});
    }
}

void Config::note_effective(std::string_view section, DescribedRef object) {
    ordered_json* place = &*effective_;
    while (!section.empty()) {
        const std::size_t dot = section.find('.');
        place = &(*place)[std::string(section.substr(0, dot))];
        section = dot == std::string_view::npos ? std::string_view() : section.substr(dot + 1);
    }
    if (place->is_object())
        place->update(to_json(object), true);
    else
        *place = to_json(object);
}

bool Config::has(std::string_view path) const {
    const auto below = [path](const auto& entry) { return is_at_or_below(entry.first, path); };
    return std::any_of(leaves_.begin(), leaves_.end(), below) ||
           std::any_of(empty_tables_.begin(), empty_tables_.end(), below);
}

void Config::expect_all_used() const {
    std::vector<std::string> names(known_.begin(), known_.end());
    for (const auto& [path, leaf] : leaves_)
        if (!leaf.used)
            throw InputError(fmt::format("{}: unknown key '{}'{}", leaf.place, path, did_you_mean(path, names)));
    names.assign(sections_.begin(), sections_.end());
    for (const auto& table : empty_tables_) {
        const auto& [path, place] = table;
        const auto holds = [&table](const std::string& known) { return is_at_or_below(known, table.first); };
        if (std::none_of(known_.begin(), known_.end(), holds) && std::none_of(names.begin(), names.end(), holds))
            throw InputError(fmt::format("{}: unknown section '{}'{}", place, path, did_you_mean(path, names)));
    }
}

std::map<std::string, Origin> Config::origins() const {
    std::map<std::string, Origin> origins;
    for (const auto& [path, leaf] : leaves_)
        if (leaf.has_origin) origins.emplace(path, leaf.origin);
    return origins;
}

} // namespace sim
