#include "sim/described_json.hpp"

#include "sim/suggest.hpp"

#include <charconv>
#include <fmt/format.h>

namespace sim::detail {

namespace {

std::string short_text(const Json& json) {
    if (json.is_object()) return "a table";
    if (json.is_number_float()) return number_text(json.get<double>());
    std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() > 60) text = text.substr(0, 57) + "...";
    return text;
}

std::string message(const JsonPlace& where, std::string_view what, const Json& got) {
    const std::string path = where.path.empty() ? "" : where.path + ": ";
    return fmt::format("{}: {}expected {}, got {}", where.place, path, what, short_text(got));
}

std::uint64_t number_in(const Json& json, const char* key, const JsonPlace& where) {
    const auto found = json.find(key);
    if (found == json.end()) return 0;
    if (!fits<std::uint64_t>(*found)) expected({where.place, join_path(where.path, key)}, "a count", *found);
    return found->get<std::uint64_t>();
}

} // namespace

void expected(const JsonPlace& where, std::string_view what, const Json& got) {
    throw InputError(message(where, what, got));
}

void expected_choice(const JsonPlace& where, const std::vector<std::string>& names, const Json& got) {
    const std::string word = got.is_string() ? got.get<std::string>() : "";
    throw InputError(message(where, fmt::format("one of {}", fmt::join(names, " | ")), got) +
                     did_you_mean(word, names));
}

void unknown_key(const JsonPlace& where, const std::string& key, const std::vector<std::string>& known) {
    std::vector<std::string> paths;
    for (const std::string& name : known) paths.push_back(join_path(where.path, name));
    const std::string path = join_path(where.path, key);
    throw InputError(fmt::format("{}: unknown key '{}'{}", where.place, path, did_you_mean(path, paths)));
}

std::string with_range(std::string type, const std::string& range) {
    if (!range.empty()) type += " " + range;
    return type;
}

// Only bins that hold something are written: {"start": count}.
Json histogram_to_json(const Histogram& histogram) {
    Json bins = Json::object();
    for (std::size_t bin = 0; bin < Histogram::bin_count; ++bin)
        if (histogram.bins()[bin] != 0) bins[std::to_string(histogram.bin_start(bin))] = histogram.bins()[bin];
    return {{"count", histogram.count()}, {"sum", histogram.sum()},   {"min", histogram.min()},
            {"max", histogram.max()},     {"mean", histogram.mean()}, {"bin_width", histogram.bin_width()},
            {"bins", std::move(bins)}};
}

Histogram histogram_from_json(const Json& json, const JsonPlace& where) {
    if (!json.is_object()) expected(where, "a histogram", json);
    const std::uint64_t width = number_in(json, "bin_width", where);
    const Histogram shape = width == 0 ? Histogram() : Histogram::linear(width);
    Histogram::Bins bins{};
    if (const auto list = json.find("bins"); list != json.end()) {
        if (!list->is_object()) expected({where.place, where.path + ".bins"}, "a table", *list);
        for (const auto& item : list->items()) {
            std::uint64_t start = 0;
            const char* end = item.key().data() + item.key().size();
            const auto parsed = std::from_chars(item.key().data(), end, start);
            const bool good = parsed.ec == std::errc() && parsed.ptr == end;
            const std::size_t bin = shape.bin_of(start);
            if (!good || shape.bin_start(bin) != start)
                expected({where.place, where.path + ".bins"}, "starts of bins as keys", item.key());
            bins[bin] = number_in(*list, item.key().c_str(), where);
        }
    }
    return Histogram::from_parts(width, number_in(json, "sum", where), number_in(json, "min", where),
                                 number_in(json, "max", where), bins);
}

} // namespace sim::detail
