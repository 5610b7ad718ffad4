#include "traces/recording/import/vertex_elements.hpp"

#include "traces/record_module/element_types.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace traces::recorded {

using pipeline::ComponentType;

namespace {

template <class T>
double number_at(const std::byte* bytes) {
    T value{};
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
}

/// A component as the number that is stored, and the largest one of its type.
struct StoredNumber {
    double value = 0.0, largest = 1.0;
};

StoredNumber stored_number(std::uint32_t type, const std::byte* bytes) {
    switch (type) {
    case GL_BYTE:
        return {number_at<std::int8_t>(bytes), 127.0};
    case GL_UNSIGNED_BYTE:
        return {number_at<std::uint8_t>(bytes), 255.0};
    case GL_SHORT:
        return {number_at<std::int16_t>(bytes), 32767.0};
    case GL_UNSIGNED_SHORT:
        return {number_at<std::uint16_t>(bytes), 65535.0};
    case GL_INT:
        return {number_at<std::int32_t>(bytes), 2147483647.0};
    case GL_UNSIGNED_INT:
        return {number_at<std::uint32_t>(bytes), 4294967295.0};
    case GL_FIXED:
        return {number_at<std::int32_t>(bytes) / 65536.0, 1.0};
    case GL_DOUBLE:
        return {number_at<double>(bytes), 1.0};
    default:
        return {number_at<float>(bytes), 1.0};
    }
}

/// x, y and z of 10 bits, w of 2.
StoredNumber packed_number(std::uint32_t type, const std::byte* bytes, std::uint32_t component) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes, sizeof word);
    const std::uint32_t bits = component == 3 ? 2 : 10, shift = component * 10;
    if (type == GL_UNSIGNED_INT_2_10_10_10_REV)
        return {static_cast<double>(word >> shift & ((1U << bits) - 1)), static_cast<double>((1U << bits) - 1)};
    const auto value = static_cast<std::int32_t>(word << (32 - shift - bits)) >> (32 - bits);
    return {static_cast<double>(value), static_cast<double>((1U << (bits - 1)) - 1)};
}

} // namespace

std::optional<ComponentType> component_type_of(const record_stream::Array& array) {
    if (array.components == GL_BGRA) return std::nullopt;
    switch (array.type) {
    case GL_FLOAT:
        return ComponentType::f32;
    case GL_HALF_FLOAT:
        return ComponentType::f16;
    case GL_BYTE:
        return ComponentType::s8;
    case GL_UNSIGNED_BYTE:
        return ComponentType::u8;
    case GL_SHORT:
        return ComponentType::s16;
    case GL_UNSIGNED_SHORT:
        return ComponentType::u16;
    case GL_UNSIGNED_INT:
        return ComponentType::u32;
    case GL_INT: // the same bits, where nobody makes floats of them
        return array.integer ? std::optional(ComponentType::u32) : std::nullopt;
    case GL_INT_2_10_10_10_REV:
        return ComponentType::s10_10_10_2;
    case GL_UNSIGNED_INT_2_10_10_10_REV:
        return ComponentType::u10_10_10_2;
    default:
        return std::nullopt;
    }
}

std::vector<std::byte> as_floats(const record_stream::Array& array, std::span<const std::byte> bytes,
                                 std::uint64_t elements) {
    const std::uint32_t components = record_stream::components_of(array);
    constexpr std::array<std::uint32_t, 4> blue_first{2, 1, 0, 3};
    std::vector<float> values;
    values.reserve(elements * components);
    for (std::uint64_t i = 0; i < elements; ++i) {
        const std::byte* const element = bytes.data() + array.offset + i * array.stride;
        for (std::uint32_t c = 0; c < components; ++c) {
            const std::uint32_t source = array.components == GL_BGRA ? blue_first.at(c) : c;
            const StoredNumber number =
                record_stream::is_packed(array.type)
                    ? packed_number(array.type, element, source)
                    : stored_number(array.type, element + std::size_t{source} * record_stream::type_bytes(array.type));
            values.push_back(
                static_cast<float>(array.normalized ? std::max(number.value / number.largest, -1.0) : number.value));
        }
    }
    const auto raw = std::as_bytes(std::span(values));
    return {raw.begin(), raw.end()};
}

} // namespace traces::recorded
