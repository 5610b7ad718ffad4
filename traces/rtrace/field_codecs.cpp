#include "traces/rtrace/field_codecs.hpp"

#include "sim/check.hpp"
#include "traces/rtrace/little_endian.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace traces::rtrace {

bool is_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = [&](std::size_t at) {
            return at < text.size() ? static_cast<std::uint8_t>(text[at]) : std::uint8_t{0};
        };
        const std::uint8_t lead = byte(i);
        const std::size_t more = lead < 0x80 ? 0 : lead < 0xC2 ? 4 : lead < 0xE0 ? 1 : lead < 0xF0 ? 2 : 3;
        if (more == 4 || lead > 0xF4) return false;
        for (std::size_t k = 1; k <= more; ++k)
            if ((byte(i + k) & 0xC0U) != 0x80) return false;
        const std::uint8_t second = byte(i + 1); // neither longer than needed, nor a surrogate, nor beyond U+10FFFF
        if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F) || (lead == 0xF0 && second < 0x90) ||
            (lead == 0xF4 && second > 0x8F))
            return false;
        i += 1 + more;
    }
    return true;
}

void Encoder::put(std::uint64_t value, std::size_t bytes) {
    std::array<std::byte, 8> little{};
    put_little(little.data(), value);
    bytes_.insert(bytes_.end(), little.begin(), little.begin() + static_cast<std::ptrdiff_t>(bytes));
}

void Encoder::text(std::string_view name, std::string& value) {
    if (!is_utf8(value)) throw sim::InputError(fmt::format("{}: {}: expected UTF-8, got '{}'", place_, name, value));
    CHECK(value.size() <= UINT32_MAX);
    put(value.size(), 4);
    const auto bytes = std::as_bytes(std::span(value));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

void Encoder::numbers(std::string_view name, std::span<float> values) {
    for (const float value : values) {
        if (!std::isfinite(value)) throw sim::InputError(fmt::format("{}: {}: expected finite numbers", place_, name));
        put(std::bit_cast<std::uint32_t>(value), 4);
    }
}

void Encoder::blob(std::string_view, BlobName& value) {
    const auto bytes = std::as_bytes(std::span(value.content.bytes));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    put(value.bytes, 8);
}

void Encoder::whole_number(std::string_view, std::uint64_t& value, std::size_t bytes, std::uint64_t least,
                           std::uint64_t most) {
    CHECK(value >= least && value <= most);
    put(value, bytes);
}

void Encoder::integer_number(std::string_view, std::int32_t& value, std::int32_t, std::int32_t) {
    put(static_cast<std::uint32_t>(value), 4);
}

void Encoder::code_number(std::string_view, std::uint8_t& code, std::span<const std::string_view> names) {
    CHECK(code < names.size());
    put(code, 1);
}

void Encoder::words(std::string_view, std::vector<std::uint32_t>& values) {
    CHECK(values.size() <= UINT32_MAX);
    put(values.size(), 4);
    for (const std::uint32_t value : values) put(value, 4);
}

std::size_t Encoder::count(std::string_view, std::size_t records, std::size_t, std::size_t most) {
    CHECK(records <= most);
    put(records, 4);
    return records;
}

void Decoder::fail(std::string_view name, std::string_view expected) const {
    std::string path;
    for (const Step& step : path_)
        path += fmt::format("{} ", step.number ? fmt::format("{} {}", step.name, *step.number) : step.name);
    throw sim::InputError(fmt::format("{}: content byte {}: {}{}: expected {}", place_, field_, path, name, expected));
}

std::span<const std::byte> Decoder::take(std::string_view name, std::uint64_t bytes) {
    const std::size_t left = bytes_.size() - at_;
    if (bytes > left) fail(name, fmt::format("{} bytes, got {}", bytes, left));
    at_ += bytes;
    return bytes_.subspan(at_ - bytes, bytes);
}

std::uint64_t Decoder::get(std::string_view name, std::size_t bytes) {
    field_ = at_;
    std::array<std::byte, 8> little{};
    std::ranges::copy(take(name, bytes), little.begin());
    return get_little<std::uint64_t>(little.data());
}

void Decoder::finish() {
    field_ = at_;
    if (at_ != bytes_.size()) fail("end", fmt::format("the end of the chunk, got {} more bytes", bytes_.size() - at_));
}

void Decoder::text(std::string_view name, std::string& value) {
    const auto bytes = take(name, get(name, 4));
    value.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!is_utf8(value)) fail(name, "UTF-8");
}

void Decoder::numbers(std::string_view name, std::span<float> values) {
    for (float& value : values) {
        value = std::bit_cast<float>(static_cast<std::uint32_t>(get(name, 4)));
        if (!std::isfinite(value)) fail(name, fmt::format("a finite number, got {}", value));
    }
}

void Decoder::blob(std::string_view name, BlobName& value) {
    field_ = at_;
    std::memcpy(value.content.bytes.data(), take(name, value.content.bytes.size()).data(), value.content.bytes.size());
    value.bytes = get(name, 8);
}

void Decoder::whole_number(std::string_view name, std::uint64_t& value, std::size_t bytes, std::uint64_t least,
                           std::uint64_t most) {
    value = get(name, bytes);
    if (value < least || value > most) fail(name, fmt::format("{} to {}, got {}", least, most, value));
}

void Decoder::integer_number(std::string_view name, std::int32_t& value, std::int32_t least, std::int32_t most) {
    value = static_cast<std::int32_t>(static_cast<std::uint32_t>(get(name, 4)));
    if (value < least || value > most) fail(name, fmt::format("{} to {}, got {}", least, most, value));
}

void Decoder::code_number(std::string_view name, std::uint8_t& code, std::span<const std::string_view> names) {
    code = static_cast<std::uint8_t>(get(name, 1));
    if (code >= names.size())
        fail(name, fmt::format("a code below {} ({}), got {}", names.size(), fmt::join(names, ", "), code));
}

void Decoder::words(std::string_view name, std::vector<std::uint32_t>& values) {
    const auto bytes = take(name, 4 * get(name, 4));
    values.resize(bytes.size() / 4);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = get_little<std::uint32_t>(&bytes[4 * i]);
}

std::size_t Decoder::count(std::string_view kind, std::size_t, std::size_t least_bytes, std::size_t most) {
    const std::uint64_t records = get(kind, 4), room = (bytes_.size() - at_) / least_bytes;
    if (records > room) fail(kind, fmt::format("at most {} records in the bytes that are left, got {}", room, records));
    if (records > most) fail(kind, fmt::format("at most {} records, got {}", most, records));
    return records;
}

} // namespace traces::rtrace
