// Names of generated scenes: what follows "gen:".
#include "traces/generators.hpp"
#include "tests/fuzz/expect_input_error.hpp"

#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <string_view>

namespace {

// Millions of triangles are allowed, and take their time: numbers have at most three digits here, and no exponent.
bool has_small_numbers(std::string_view text) {
    std::size_t digits = 0;
    for (const char c : text) {
        const auto letter = static_cast<unsigned char>(c);
        if (digits > 0 && (letter == 'e' || letter == 'E')) return false;
        digits = std::isdigit(letter) != 0 ? digits + 1 : 0;
        if (digits > 3) return false;
    }
    return true;
}

// By default, scenes are as large as the figures they stand for.
std::string with_small_default(std::string text) {
    struct Size {
        std::string_view generator, parameter;
    };
    constexpr std::array<Size, 5> sizes{
        {{"grass", "blades"}, {"blob", "triangles"}, {"grid-soup", "boxes"}, {"random-quads", "n"}, {"discs", "n"}}};
    const std::string id = text.substr(0, text.find('?'));
    for (const auto& [generator, parameter] : sizes)
        if (id == generator && text.find(std::string(parameter) + '=') == std::string::npos)
            text += fmt::format("{}{}=100", id == text ? '?' : '&', parameter);
    return text;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(bytes), size);
    if (!has_small_numbers(text)) return -1;
    fuzz::expect_result_or_input_error([&] { traces::generate_scene("gen:" + with_small_default(text)); });
    return 0;
}
