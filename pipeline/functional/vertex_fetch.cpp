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

/// Three components of 10 bits and one of 2; `normalized` divides by the largest value of each.
template <bool is_signed>
glm::vec4 packed_10_10_10_2(const std::byte* source, bool normalized) {
    constexpr std::array<std::uint32_t, 4> widths{10, 10, 10, 2};
    std::uint32_t word = 0;
    std::memcpy(&word, source, sizeof(word));
    glm::vec4 result;
    std::uint32_t first = 0;
    for (std::size_t i = 0; i < widths.size(); first += widths[i++]) {
        const std::uint32_t field = word >> first & ((1U << widths[i]) - 1);
        const bool negative = is_signed && (field >> (widths[i] - 1)) != 0;
        double value = static_cast<double>(field) - (negative ? static_cast<double>(1U << widths[i]) : 0.0);
        const std::uint32_t largest = (1U << (widths[i] - (is_signed ? 1 : 0))) - 1;
        if (normalized) value = std::max(value / largest, -1.0);
        result[static_cast<int>(i)] = static_cast<float>(value);
    }
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
    case ComponentType::s10_10_10_2:
        return packed_10_10_10_2<true>(source, normalized_);
    case ComponentType::u10_10_10_2:
        return packed_10_10_10_2<false>(source, normalized_);
    case ComponentType::f32:
        break;
    }
    return floats(source);
}

bool has_elements_for(const Resources& resources, const VertexAttribute& attribute, std::uint64_t instances) {
    if (attribute.divisor == 0 || instances == 0) return true;
    const std::uint64_t bytes = resources.buffers[attribute.buffer].bytes.size();
    if (attribute.offset > bytes || attribute.bytes() > bytes - attribute.offset) return false;
    return (instances - 1) / attribute.divisor <= (bytes - attribute.offset - attribute.bytes()) / attribute.stride;
}

std::vector<IndexRun> index_runs(const Resources& resources, const Geometry& geometry) {
    const IndexReader index(resources, geometry);
    std::vector<IndexRun> runs;
    std::uint32_t begin = 0;
    std::uint32_t primitives = 0;
    for (std::uint64_t i = 0; i <= geometry.index_count; ++i) {
        const auto place = static_cast<std::uint32_t>(i);
        if (i < geometry.index_count && index(place) != restart_index(geometry.index_type)) continue;
        if (const std::uint32_t made = primitives_of(geometry.topology, place - begin); made > 0) {
            runs.push_back({begin, primitives});
            primitives += made;
        }
        begin = place + 1;
    }
    runs.push_back({geometry.index_count, primitives});
    return runs;
}

VertexRange used_vertices(const Resources& resources, const Geometry& geometry) {
    return used_vertices(resources, geometry, 0, geometry.index_count);
}

VertexRange used_vertices(const Resources& resources, const Geometry& geometry, std::uint32_t first,
                          std::uint32_t count) {
    if (geometry.index_type == IndexType::none) return {first, first + count};
    const IndexReader index(resources, geometry, first);
    const std::uint32_t restart = restart_index(geometry.index_type);
    VertexRange used{std::numeric_limits<std::uint32_t>::max(), 0};
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t value = index(i);
        if (geometry.primitive_restart && value == restart) continue;
        used.first = std::min(used.first, value);
        used.end = std::max(used.end, value + 1);
    }
    return used.end == 0 ? VertexRange{} : used;
}

} // namespace pipeline
