#include "traces/gltf/property_check.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

namespace traces::gltf {

using nlohmann::json;

namespace {

constexpr std::string_view any_key = "*";
constexpr std::string_view any_owner;

using Rows = std::vector<const Property*>;

const Rows& rows_of(std::string_view owner) {
    static const std::map<std::string_view, Rows> by_owner = [] {
        std::map<std::string_view, Rows> rows;
        for (const Property& property : properties()) rows[property.owner].push_back(&property);
        return rows;
    }();
    static const Rows none;
    const auto found = by_owner.find(owner);
    return found == by_owner.end() ? none : found->second;
}

/// Calls use(value) for the parts of "a|b|c".
template <class Use>
void each_of(std::string_view values, Use&& use) {
    for (;;) {
        const std::size_t bar = values.find('|');
        use(values.substr(0, bar));
        if (bar == std::string_view::npos) return;
        values.remove_prefix(bar + 1);
    }
}

std::string spelled(std::string_view values, std::string_view quote) {
    std::string text;
    each_of(values, [&](std::string_view value) {
        text += fmt::format("{}{}{}{}", text.empty() ? "" : ", ", quote, value, quote);
    });
    return text;
}

bool is_among(std::string_view values, std::string_view wanted) {
    bool found = false;
    each_of(values, [&](std::string_view value) { found = found || value == wanted; });
    return found;
}

std::optional<std::int64_t> whole_in(const json& value) {
    if (value.is_number_unsigned() && value.get<std::uint64_t>() > std::uint64_t{1} << 62U) return std::nullopt;
    if (value.is_number_integer()) return value.get<std::int64_t>();
    if (!value.is_number_float()) return std::nullopt;
    const double number = value.get<double>();
    constexpr double exact = 0x1p53;
    if (!(std::fabs(number) <= exact) || number != std::floor(number)) return std::nullopt;
    return static_cast<std::int64_t>(number);
}

class Checker {
  public:
    Checker(const std::string& file, const json& document, std::vector<std::string>& notes)
        : file_(file), document_(document), notes_(notes) {}

    void object(json& value, std::string_view type) {
        if (!value.is_object()) fail("an object", &value);
        for (const Property* property : rows_of(type)) this->property(value, *property);
        for (const Property* property : rows_of(any_owner)) this->property(value, *property);
    }

  private:
    void property(json& owner, const Property& row) {
        if (row.key == any_key) {
            for (const auto& [key, value] : owner.items()) member(key, value, row.shape);
            return;
        }
        const auto found = owner.find(row.key);
        if (found == owner.end()) {
            if (!row.shape.is_needed) return;
            const Place place(path_, row.key);
            fail(wanted(row.shape), nullptr);
        }
        if (!row.shape.is_unread) return member(row.key, *found, row.shape);
        try {
            member(row.key, *found, row.shape);
        } catch (const sim::InputError& error) {
            notes_.push_back(
                fmt::format("{} (nothing depends on it)", std::string_view(error.what()).substr(file_.size() + 2)));
        }
        owner.erase(found);
    }

    void member(std::string_view key, json& value, const Shape& shape) {
        const Place place(path_, key);
        if (!shape.is_list) return one(value, shape);
        if (!value.is_array()) fail(list_wanted(shape), &value);
        if (value.empty() && shape.fewest == 1)
            notes_.push_back(fmt::format("{}: empty, where glTF wants at least one element", path_));
        else if (value.size() < shape.fewest || value.size() > shape.longest)
            fail(list_wanted(shape), &value);
        std::set<json> seen;
        for (std::size_t i = 0; i < value.size(); ++i) {
            const Place element(path_, i);
            one(value[i], shape);
            if (shape.is_unique && !seen.insert(value[i]).second) fail("nothing twice", &value[i]);
        }
    }

    void one(json& value, const Shape& shape) {
        switch (shape.kind) {
        case Kind::object:
            return object(value, shape.of);
        case Kind::text:
            return require(value.is_string(), shape, value);
        case Kind::flag:
            return require(value.is_boolean(), shape, value);
        case Kind::words:
            return require(value.is_string() && is_among(shape.of, value.get_ref<const std::string&>()), shape, value);
        case Kind::number: {
            require(value.is_number(), shape, value);
            const double number = value.get<double>();
            return require(number >= shape.least && number <= shape.most && !(shape.above && number == shape.least),
                           shape, value);
        }
        case Kind::whole:
        case Kind::one_of:
        case Kind::index:
            return whole(value, shape);
        }
    }

    void whole(json& value, const Shape& shape) {
        const std::optional<std::int64_t> number = whole_in(value);
        require(number.has_value(), shape, value);
        if (shape.kind == Kind::whole)
            require(static_cast<double>(*number) >= shape.least && static_cast<double>(*number) <= shape.most, shape,
                    value);
        else if (shape.kind == Kind::one_of)
            require(is_among(shape.of, fmt::format("{}", *number)), shape, value);
        else
            require(*number >= 0 && static_cast<std::uint64_t>(*number) < length_of(shape.of), shape, value);
        value = *number;
    }

    std::size_t length_of(std::string_view list) {
        const auto [entry, is_new] = lengths_.try_emplace(list, 0);
        const json::json_pointer pointer{std::string(list)};
        if (!is_new || !document_.contains(pointer)) return entry->second;
        const json& found = document_.at(pointer);
        if (!found.is_array()) fail_at(list.substr(1), "a list", &found);
        return entry->second = found.size();
    }

    std::string wanted(const Shape& shape) {
        switch (shape.kind) {
        case Kind::whole:
            return fmt::format("a whole number from {} to {}", shape.least, static_cast<std::int64_t>(shape.most));
        case Kind::number:
            return number_wanted(shape);
        case Kind::flag:
            return "true or false";
        case Kind::text:
            return "a text";
        case Kind::one_of:
            return fmt::format("one of {}", spelled(shape.of, ""));
        case Kind::words:
            return fmt::format("one of {}", spelled(shape.of, "\""));
        case Kind::index:
            return fmt::format("the number of one of {} {}", length_of(shape.of),
                               shape.of.substr(shape.of.rfind('/') + 1));
        case Kind::object:
            break;
        }
        return shape.is_list ? list_wanted(shape) : "an object";
    }

    static std::string number_wanted(const Shape& shape) {
        constexpr double unbounded = 1e38;
        if (shape.least < -unbounded) return "a finite number";
        if (shape.most > unbounded)
            return fmt::format("a finite number {} {}", shape.above ? "above" : "of at least", shape.least);
        return fmt::format("a number {} {} to {}", shape.above ? "above" : "from", shape.least, shape.most);
    }

    std::string list_wanted(const Shape& shape) const {
        if (shape.fewest == shape.longest) return fmt::format("a list of {}", shape.fewest);
        return "a list";
    }

    void require(bool good, const Shape& shape, const json& value) {
        if (!good) fail(wanted(shape), &value);
    }

    [[noreturn]] void fail(std::string_view expected, const json* value) const {
        fail_at(path_.empty() ? "JSON" : path_, expected, value);
    }

    [[noreturn]] void fail_at(std::string_view path, std::string_view expected, const json* value) const {
        throw sim::InputError(fmt::format("{}: {}: expected {}, got {}", file_, path, expected,
                                          value == nullptr ? "nothing" : one_line(value->dump().substr(0, 40))));
    }

    // Where in the document the checker is, for as long as it is there.
    class Place {
      public:
        Place(std::string& path, std::string_view key) : path_(path), length_(path.size()) {
            if (!path.empty()) path += '.';
            path += one_line(std::string(key.substr(0, 40)));
        }
        Place(std::string& path, std::size_t element) : path_(path), length_(path.size()) {
            path += '[';
            path += std::to_string(element);
            path += ']';
        }
        ~Place() { path_.resize(length_); }
        Place(const Place&) = delete;
        Place& operator=(const Place&) = delete;

      private:
        std::string& path_;
        std::size_t length_;
    };

    const std::string& file_;
    const json& document_;
    std::vector<std::string>& notes_;
    std::string path_;
    std::map<std::string_view, std::size_t> lengths_;
};

} // namespace

void check_properties(const std::string& file, json& document, std::vector<std::string>& notes) {
    Checker(file, document, notes).object(document, "document");
}

std::string got(const json& value) {
    return value.is_null() ? std::string() : fmt::format(", got {}", one_line(value.dump().substr(0, 40)));
}

std::string one_line(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    if (text.size() > 200) text.resize(200);
    return text;
}

} // namespace traces::gltf
