#include "traces/preparation/formats.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace traces {

using pipeline::ComponentType;
using pipeline::VertexAttribute;

namespace {

template <class Integer>
void store_integer(std::byte* target, float value, bool normalized) {
    constexpr double least = std::numeric_limits<Integer>::min(), most = std::numeric_limits<Integer>::max();
    if (std::isnan(value)) value = 0.0F; // has no place among integers
    const double scaled = static_cast<double>(value) * (normalized ? most : 1.0);
    const auto integer =
        static_cast<Integer>(std::clamp(std::round(scaled), normalized ? std::max(least, -most) : least, most));
    std::memcpy(target, &integer, sizeof integer);
}

void store(std::byte* target, float value, ComponentType type, bool normalized) {
    switch (type) {
    case ComponentType::s8:
        return store_integer<std::int8_t>(target, value, normalized);
    case ComponentType::u8:
        return store_integer<std::uint8_t>(target, value, normalized);
    case ComponentType::s16:
        return store_integer<std::int16_t>(target, value, normalized);
    case ComponentType::u16:
        return store_integer<std::uint16_t>(target, value, normalized);
    default:
        CHECK(type == ComponentType::f32);
        std::memcpy(target, &value, sizeof value);
    }
}

} // namespace

std::vector<glm::vec4> values_of(const Column& column) {
    VertexAttribute packed = column.format;
    packed.offset = 0;
    packed.stride = packed.bytes();
    const pipeline::AttributeReader read(column.elements.data(), packed);
    std::vector<glm::vec4> values(column.elements.size() / packed.stride);
    for (std::uint32_t i = 0; i < values.size(); ++i) values[i] = read(i);
    return values;
}

Column column_from(const VertexAttribute& format, const std::vector<glm::vec4>& values) {
    const std::uint32_t size = format.bytes();
    Column column{format, std::vector<std::byte>(values.size() * size)};
    std::byte* target = column.elements.data();
    for (const glm::vec4& value : values)
        for (std::uint32_t i = 0; i < format.components; ++i, target += size / format.components)
            store(target, value[static_cast<int>(i)], format.type, format.normalized);
    return column;
}

VertexAttribute with_format(VertexAttribute attribute, ComponentType type, std::uint8_t components, bool normalized) {
    attribute.type = type;
    attribute.components = components;
    attribute.normalized = normalized;
    return attribute;
}

} // namespace traces
