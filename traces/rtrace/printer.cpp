#include "traces/rtrace/printer.hpp"

#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace traces {

std::string TraceLine::text() const {
    std::string text = place + ":";
    for (const auto& [name, value] : fields) text += fmt::format(" {}={}", name, value);
    return text;
}

namespace rtrace {

namespace {

// Nothing that a terminal would obey; other characters stay as they are.
std::string in_double_quotes(std::string_view text) {
    std::string result = "\"";
    for (const char letter : text) {
        const auto byte = static_cast<std::uint8_t>(letter);
        if (letter == '\n')
            result += "\\n";
        else if (byte < 0x20 || byte == 0x7F)
            result += fmt::format("\\x{:02x}", byte);
        else if (letter == '"' || letter == '\\')
            result += std::string("\\") + letter;
        else
            result += letter;
    }
    return result + "\"";
}

// As a float where it looks like one, with a point or an exponent; else as a whole number. No two words give one text.
std::string word_text(std::uint32_t word) {
    const auto number = std::bit_cast<float>(word);
    constexpr float least = 0x1p-40F, most = 0x1p40F;
    if (!(std::fabs(number) >= least && std::fabs(number) < most))
        return std::to_string(static_cast<std::int32_t>(word));
    std::string text = fmt::format("{}", number);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
}

} // namespace

void Printer::begin(std::string place) {
    open_ = {{lines.size(), ""}};
    lines.push_back({std::move(place), {}});
}

void Printer::enter(std::string_view kind, std::size_t i) {
    const std::string outer = open_.size() > 1 ? lines[open_.back().line].place + " " : "";
    open_.push_back({lines.size(), ""});
    lines.push_back({fmt::format("{}{} {}", outer, kind, i), {}});
}

void Printer::enter_part(std::string_view name) {
    open_.push_back({open_.back().line, fmt::format("{}{} ", open_.back().part, name)});
}

void Printer::add(std::string_view name, std::string value) {
    lines[open_.back().line].fields.emplace_back(open_.back().part + std::string(name), std::move(value));
}

void Printer::text(std::string_view name, std::string& value) { add(name, in_double_quotes(value)); }

void Printer::numbers(std::string_view name, std::span<float> values) {
    add(name, fmt::format("{}", fmt::join(values, ",")));
}

void Printer::blob(std::string_view name, BlobName& value) {
    add(name, fmt::format("{}:{}", value.content.hex(), value.bytes));
}

void Printer::words(std::string_view name, std::vector<std::uint32_t>& values) {
    std::string text;
    for (const std::uint32_t value : values) text += (text.empty() ? "" : ",") + word_text(value);
    add(name, std::move(text));
}

void Printer::derived(std::string_view name, std::uint64_t value) { add(name, std::to_string(value)); }

void Printer::whole_number(std::string_view name, std::uint64_t& value, std::size_t, std::uint64_t, std::uint64_t) {
    add(name, std::to_string(value));
}

void Printer::integer_number(std::string_view name, std::int32_t& value, std::int32_t, std::int32_t) {
    add(name, std::to_string(value));
}

void Printer::code_number(std::string_view name, std::uint8_t& code, std::span<const std::string_view> names) {
    add(name, std::string(names[code]));
}

std::size_t Printer::count(std::string_view kind, std::size_t records, std::size_t, std::size_t) {
    add(fmt::format("{} records", kind), std::to_string(records));
    return records;
}

} // namespace rtrace

} // namespace traces
