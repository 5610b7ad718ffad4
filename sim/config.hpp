// The configuration of a run: a TOML file, overridden by `--set section.key=value`, read into described structs.
//
// Every value knows where it was written, so that an error names file, line and column. A table that has a key `value`
// is a value with its origin: clk_MHz = { value = 650, origin = "public", source = "...", note = "..." }.
#pragma once

#include "sim/described.hpp"
#include "sim/json_value.hpp"

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace sim {

/// Where a number comes from; all texts of the file, or "command line".
struct Origin {
    std::string origin; ///< "public", "measured", "calibrated", "assumed", "off", "command line"
    std::string source;
    std::string note;
    friend bool operator==(const Origin&, const Origin&) = default;
};

class Config {
  public:
    Config() = default;
    static Config from_toml_file(const std::filesystem::path& path);
    static Config from_toml_text(std::string_view text, const std::string& name);

    /// "cache.lines=64", as from the command line; later ones win. Text needs no quotes: "cache.policy=lru". `place`
    /// begins what errors say of it.
    void set(std::string_view assignment, const std::string& place = "--set");

    /// Takes every value of `base` that is not configured here, with its place and origin.
    void complete_from(const Config& base);

    /// The text at `path`, which then counts as read; "" when nothing is configured there. Throws InputError when it is
    /// no text.
    std::string take_text(const std::string& path);

    /// Overwrites those fields of `object` that are configured below the dotted path `section` ("" is the root).
    template <Described S>
    void read(std::string_view section, S& object) {
        read_table(section, struct_table<S>, &object);
        note_effective(section, DescribedRef(object));
    }

    /// True when anything at or below the dotted path is configured.
    bool has(std::string_view path) const;

    /// Throws InputError when a key or section was configured that no read() asked for.
    void expect_all_used() const;

    /// All structs read so far with all their values, as nested objects.
    const nlohmann::ordered_json& effective() const { return *effective_; }

    /// The values whose origin is stated, by path.
    std::map<std::string, Origin> origins() const;

  private:
    struct Leaf {
        JsonValue value;
        std::string place; ///< "g70.toml:12:3", "--set"
        std::string raw;   ///< the text after `=` of a --set
        Origin origin;
        bool has_origin = false;
        bool used = false;
    };
    struct Inserter;

    void insert_toml(std::string_view text, const std::string& name, const std::string* raw);
    void read_table(std::string_view section, const StructTable& table, void* object);
    void read_fields(const std::string& section, const StructTable& table, void* object);
    void note_effective(std::string_view section, DescribedRef object);
    /// The leaf at `path`, marked as used; nullptr when there is none.
    const Leaf* use(const std::string& path, bool is_text);
    /// A struct is read at `path`: a plain value there is an error.
    void expect_table(const std::string& path) const;

    std::map<std::string, Leaf> leaves_;
    std::map<std::string, std::string> empty_tables_; ///< path -> place
    std::set<std::string> known_;                     ///< every path that a read() asked for
    std::set<std::string> sections_;
    JsonValue effective_;
};

} // namespace sim
