// Reading the data files of reports/: every error names file, line and what was expected.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <toml++/toml.h>
#include <vector>

namespace reports {

/// One table of a file. Keys that nobody asked for are an error when the reader is done (expect_all_read).
class TomlTable {
  public:
    TomlTable(const toml::table& table, std::string file) : table_(&table), file_(std::move(file)) {}

    std::string text(std::string_view key);
    std::string text_or(std::string_view key, std::string otherwise);
    double number(std::string_view key);
    double number_or(std::string_view key, double otherwise);
    bool flag_or(std::string_view key, bool otherwise);
    std::vector<std::string> texts(std::string_view key); ///< empty when missing
    std::vector<double> numbers(std::string_view key);
    /// Calls `each` for every key of a table of values; nothing when missing.
    void entries(std::string_view key, const std::function<void(const std::string&, const toml::node&)>& each);
    /// Calls `each` for every table of a list of tables; nothing when missing.
    void tables(std::string_view key, const std::function<void(TomlTable&)>& each);

    /// Calls `each` with every table of a list, its values as texts.
    void entry_lists(std::string_view key, const std::function<void(const std::map<std::string, std::string>&)>& each);

    void expect_all_read() const;
    /// Throws sim::InputError "file:line:column: key: expected WHAT".
    [[noreturn]] void expected(std::string_view key, std::string_view what) const;

  private:
    const toml::node* find(std::string_view key);
    std::string place(const toml::node& node) const;

    const toml::table* table_;
    std::string file_;
    std::vector<std::string> read_;
};

/// Parses a data file of the project (ropsim_build::find_data) and hands its root to `read`.
void read_data_file(const std::filesystem::path& relative, const std::function<void(TomlTable&)>& read);
void read_toml_file(const std::filesystem::path& path, const std::function<void(TomlTable&)>& read);

/// The value that a key names; the first one when the key is missing.
template <class E, std::size_t n>
E choice(TomlTable& table, std::string_view key, const std::array<std::string_view, n>& names) {
    const std::string text = table.text_or(key, std::string(names.front()));
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end()) table.expected(key, fmt::format("one of {}", fmt::join(names, ", ")));
    return static_cast<E>(found - names.begin());
}

/// A number or text as a text: 3 -> "3", "a" -> "a".
std::string text_of_node(const toml::node& node);

} // namespace reports
