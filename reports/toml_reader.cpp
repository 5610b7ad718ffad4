#include "reports/toml_reader.hpp"

#include "ropsim_build.hpp"
#include "sim/check.hpp"
#include "sim/described.hpp"
#include "sim/read_file.hpp"
#include "sim/suggest.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace reports {

const toml::node* TomlTable::find(std::string_view key) {
    read_.emplace_back(key);
    return table_->get(key);
}

std::string TomlTable::place(const toml::node& node) const {
    return fmt::format("{}:{}:{}", file_, node.source().begin.line, node.source().begin.column);
}

void TomlTable::expected(std::string_view key, std::string_view what) const {
    const toml::node* node = table_->get(key);
    throw sim::InputError(fmt::format("{}: {}: expected {}", place(node != nullptr ? *node : *table_), key, what));
}

std::string TomlTable::text(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr || !node->is_string()) expected(key, "a text");
    return node->as_string()->get();
}

std::string TomlTable::text_or(std::string_view key, std::string otherwise) {
    return table_->contains(key) ? text(key) : (find(key), std::move(otherwise));
}

double TomlTable::number(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr || !node->is_number()) expected(key, "a number");
    return *node->value<double>();
}

double TomlTable::number_or(std::string_view key, double otherwise) {
    return table_->contains(key) ? number(key) : (find(key), otherwise);
}

bool TomlTable::flag_or(std::string_view key, bool otherwise) {
    const toml::node* node = find(key);
    if (node == nullptr) return otherwise;
    if (!node->is_boolean()) expected(key, "true or false");
    return node->as_boolean()->get();
}

std::vector<std::string> TomlTable::texts(std::string_view key) {
    std::vector<std::string> list;
    const toml::node* node = find(key);
    if (node == nullptr) return list;
    if (!node->is_array()) expected(key, "a list of texts");
    for (const toml::node& element : *node->as_array()) {
        if (!element.is_string()) expected(key, "a list of texts");
        list.push_back(element.as_string()->get());
    }
    return list;
}

std::vector<double> TomlTable::numbers(std::string_view key) {
    std::vector<double> list;
    const toml::node* node = find(key);
    if (node == nullptr) return list;
    if (!node->is_array()) expected(key, "a list of numbers");
    for (const toml::node& element : *node->as_array()) {
        if (!element.is_number()) expected(key, "a list of numbers");
        list.push_back(*element.value<double>());
    }
    return list;
}

void TomlTable::entries(std::string_view key, const std::function<void(const std::string&, const toml::node&)>& each) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    if (!node->is_table()) expected(key, "a table");
    for (const auto& [name, value] : *node->as_table()) each(std::string(name.str()), value);
}

void TomlTable::tables(std::string_view key, const std::function<void(TomlTable&)>& each) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    if (!node->is_array()) expected(key, "a list of tables");
    for (const toml::node& element : *node->as_array()) {
        if (!element.is_table()) expected(key, "a list of tables");
        TomlTable table(*element.as_table(), file_);
        each(table);
        table.expect_all_read();
    }
}

void TomlTable::entry_lists(std::string_view key,
                            const std::function<void(const std::map<std::string, std::string>&)>& each) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    if (!node->is_array()) expected(key, "a list of tables");
    for (const toml::node& element : *node->as_array()) {
        if (!element.is_table()) expected(key, "a list of tables");
        std::map<std::string, std::string> values;
        for (const auto& [name, value] : *element.as_table()) values[std::string(name.str())] = text_of_node(value);
        each(values);
    }
}

void TomlTable::expect_all_read() const {
    for (const auto& [key, value] : *table_) {
        const std::string name(key.str());
        if (std::find(read_.begin(), read_.end(), name) == read_.end())
            throw sim::InputError(
                fmt::format("{}: unknown key '{}'{}", place(value), name, sim::did_you_mean(name, read_)));
    }
}

void read_toml_file(const std::filesystem::path& path, const std::function<void(TomlTable&)>& read) {
    constexpr std::uint64_t most_bytes = std::uint64_t{16} << 20U;
    const std::string text = sim::read_file(path, most_bytes);
    try {
        const toml::table table = toml::parse(text, std::string_view(path.string()));
        TomlTable root(table, path.string());
        read(root);
        root.expect_all_read();
    } catch (const toml::parse_error& error) {
        throw sim::InputError(fmt::format("{}:{}:{}: {}", path.string(), error.source().begin.line,
                                          error.source().begin.column, error.description()));
    }
}

void read_data_file(const std::filesystem::path& relative, const std::function<void(TomlTable&)>& read) {
    const auto path = ropsim_build::find_data(relative);
    if (!path) throw sim::InputError(fmt::format("{}: not found; it belongs to the program", relative.string()));
    read_toml_file(*path, read);
}

std::string text_of_node(const toml::node& node) {
    if (const auto* text = node.as_string()) return text->get();
    if (const auto* integer = node.as_integer()) return std::to_string(integer->get());
    if (const auto* number = node.as_floating_point()) return sim::number_text(number->get());
    if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
    return {};
}

} // namespace reports
