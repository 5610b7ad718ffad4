#include "pipeline/functional/vertex_fetch.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>

namespace pipeline {

namespace {

template <class Integer>
glm::vec4 integers(const std::byte* source, std::uint32_t components, bool normalized) {
    glm::vec4 result(0.0F, 0.0F, 0.0F, 1.0F);
    std::array<Integer, 4> values{};
    std::memcpy(values.data(), source, components * sizeof(Integer));
    constexpr double largest = std::numeric_limits<Integer>::max();
    for (std::uint32_t i = 0; i < components; ++i) {
        auto value = static_cast<double>(values[i]);
        if (normalized) value = std::max(value / largest, -1.0);
        result[static_cast<int>(i)] = static_cast<float>(value);
    }
    return result;
}

glm::vec4 halves(const std::byte* source, std::uint32_t components) {
    glm::vec4 result(0.0F, 0.0F, 0.0F, 1.0F);
    std::array<std::uint16_t, 4> values{};
    std::memcpy(values.data(), source, components * sizeof(std::uint16_t));
    for (std::uint32_t i = 0; i < components; ++i) result[static_cast<int>(i)] = half_to_float(values[i]);
    return result;
}

} // namespace

glm::vec4 AttributeReader::converted(const std::byte* source) const {
    switch (type_) {
    case ComponentType::f16:
        return halves(source, components_);
    case ComponentType::s8:
        return integers<std::int8_t>(source, components_, normalized_);
    case ComponentType::u8:
        return integers<std::uint8_t>(source, components_, normalized_);
    case ComponentType::s16:
        return integers<std::int16_t>(source, components_, normalized_);
    case ComponentType::u16:
        return integers<std::uint16_t>(source, components_, normalized_);
    case ComponentType::u32:
        return integers<std::uint32_t>(source, components_, normalized_);
    case ComponentType::f32:
        break;
    }
    return floats(source);
}

VertexRange used_vertices(const Resources& resources, const Geometry& geometry) {
    if (geometry.index_count == 0) return {};
    if (geometry.index_type == IndexType::none) return {0, geometry.index_count};
    const IndexReader index(resources, geometry);
    std::uint32_t least = index(0);
    std::uint32_t greatest = least;
    for (std::uint32_t i = 1; i < geometry.index_count; ++i) {
        const std::uint32_t value = index(i);
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    }
    return {least, greatest + 1};
}

} // namespace pipeline
