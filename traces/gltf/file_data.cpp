#include "traces/gltf/file_data.hpp"

#include "sim/check.hpp"
#include "traces/gltf/property_check.hpp"

#include <array>
#include <charconv>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

namespace traces::gltf {

namespace {

std::uint32_t u32_at(const Bytes& bytes, std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

/// The value of each character as six bits, -1 for those that are none.
constexpr std::array<int, 256> six_bits() {
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<int, 256> values{};
    values.fill(-1);
    for (std::size_t i = 0; i < letters.size(); ++i)
        values[static_cast<unsigned char>(letters[i])] = static_cast<int>(i);
    return values;
}

std::optional<Bytes> from_base64(std::string_view text) {
    static constexpr std::array<int, 256> values = six_bits();
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    Bytes bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    unsigned group = 0, bits = 0;
    for (const char letter : text) {
        const int value = values[static_cast<unsigned char>(letter)];
        if (value < 0) return std::nullopt;
        group = group << 6U | static_cast<unsigned>(value);
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes.push_back(static_cast<unsigned char>(group >> bits & 0xffU));
    }
    return bytes;
}

std::string without_percents(const std::string& uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned value = 0;
        const bool escaped = uri[i] == '%' && i + 2 < uri.size();
        const char* const end = uri.data() + std::min(i + 3, uri.size());
        if (escaped && std::from_chars(uri.data() + i + 1, end, value, 16).ptr == end) {
            text += static_cast<char>(value);
            i += 2;
        } else {
            text += uri[i];
        }
    }
    return text;
}

} // namespace

std::optional<Bytes> read_file(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
    const std::uint64_t size = std::filesystem::file_size(path, error);
    if (error || size > largest_file) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    Bytes bytes(size);
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (!file || static_cast<std::uint64_t>(file.gcount()) != size) return std::nullopt;
    return bytes;
}

Parts parts_of(const std::string& name, const Bytes& bytes) {
    const auto text_at = [&](std::size_t offset, std::size_t size) {
        return std::string_view(reinterpret_cast<const char*>(bytes.data()) + offset, size);
    };
    if (!text_at(0, bytes.size()).starts_with("glTF")) return {text_at(0, bytes.size()), std::nullopt};
    const auto fail = [&](std::string_view place, const std::string& expected) {
        throw sim::InputError(fmt::format("{}: {}: expected {}", name, place, expected));
    };
    if (bytes.size() < 20) fail("header", fmt::format("at least 20 bytes, got {}", bytes.size()));
    if (u32_at(bytes, 4) != 2) fail("header", fmt::format("version 2, got {}", u32_at(bytes, 4)));
    const std::size_t length = u32_at(bytes, 8);
    if (length > bytes.size())
        fail("header", fmt::format("a file of {} bytes, got {}: it is cut off", length, bytes.size()));
    Parts parts;
    for (std::size_t offset = 12, number = 0; offset < length; ++number) {
        if (length - offset < 8) fail(fmt::format("byte {}", offset), "a chunk header of 8 bytes");
        const std::size_t chunk = u32_at(bytes, offset);
        if (chunk > length - offset - 8)
            fail(fmt::format("chunk at byte {}", offset),
                 fmt::format("at most {} bytes, got {}", length - offset - 8, chunk));
        const std::string_view type = text_at(offset + 4, 4);
        if (number == 0 && type != "JSON") fail("chunk at byte 12", "type JSON");
        if (number == 0) parts.json = text_at(offset + 8, chunk);
        if (number == 1 && type == std::string_view("BIN\0", 4))
            parts.binary = std::span(bytes).subspan(offset + 8, chunk);
        offset += 8 + chunk;
    }
    return parts;
}

std::optional<Bytes> FileData::at(const std::string& uri) {
    if (uri.starts_with("data:")) {
        constexpr std::string_view mark = ";base64,";
        const std::size_t begin = uri.find(mark);
        if (begin == std::string::npos) return std::nullopt;
        return from_base64(std::string_view(uri).substr(begin + mark.size()));
    }
    std::optional<Bytes> bytes = read_file(folder_ / without_percents(uri));
    if (!bytes) bytes = read_file(folder_ / uri); // a name with a percent sign that was not escaped
    if (bytes) hash_.add(std::as_bytes(std::span(*bytes)));
    return bytes;
}

std::string short_uri(const std::string& uri) { return one_line(uri.size() > 80 ? uri.substr(0, 77) + "..." : uri); }

} // namespace traces::gltf
