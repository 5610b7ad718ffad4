// A .glb file around bytes that are to be decoded.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace fuzz {

/// `json` with every "SIZE" replaced by the number of bytes, and the bytes as the binary chunk.
inline std::string binary_file(std::string json, const std::uint8_t* bytes, std::size_t size) {
    constexpr std::string_view mark = "SIZE";
    for (std::size_t at = json.find(mark); at != std::string::npos; at = json.find(mark))
        json.replace(at, mark.size(), std::to_string(size));
    while (json.size() % 4 != 0) json += ' ';
    const auto number = [](std::size_t value) {
        const auto low = static_cast<std::uint32_t>(value);
        std::string text(sizeof low, '\0');
        std::memcpy(text.data(), &low, sizeof low);
        return text;
    };
    return "glTF" + number(2) + number(28 + json.size() + size) + number(json.size()) + "JSON" + json + number(size) +
           std::string("BIN\0", 4) + std::string(reinterpret_cast<const char*>(bytes), size);
}

} // namespace fuzz
