#include "traces/gltf/accessors.hpp"

#include "pipeline/functional/vertex_fetch.hpp"

#include <optional>

namespace traces::gltf {

using pipeline::ComponentType;
using pipeline::VertexAttribute;

namespace {

/// Accessors without data are all zero; this many elements of them are made at most.
constexpr std::size_t most_zeros = 1U << 22U;

std::optional<ComponentType> component_type(int type) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return ComponentType::s8;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return ComponentType::u8;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return ComponentType::s16;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return ComponentType::u16;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return ComponentType::u32;
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return ComponentType::f32;
    default:
        return std::nullopt;
    }
}

std::uint8_t components_of(int type) {
    switch (type) {
    case TINYGLTF_TYPE_SCALAR:
        return 1;
    case TINYGLTF_TYPE_VEC2:
        return 2;
    case TINYGLTF_TYPE_VEC3:
        return 3;
    case TINYGLTF_TYPE_VEC4:
        return 4;
    default:
        return 0;
    }
}

bool is_unsigned_integer(ComponentType type) {
    return type == ComponentType::u8 || type == ComponentType::u16 || type == ComponentType::u32;
}

} // namespace

void Accessors::require_inside(const Elements& elements, std::size_t bytes_each, std::string_view place) const {
    const VertexAttribute& a = elements.attribute;
    const std::uint64_t start = document_.model().bufferViews.at(a.buffer).byteOffset + a.offset;
    const std::uint32_t unit = pipeline::element_bytes(a.type, 1);
    document_.require(start % unit == 0, place,
                      "a byteOffset of accessor and bufferView together that is a multiple of {}, got {}", unit, start);
    const std::size_t bytes = document_.view_bytes(static_cast<int>(a.buffer), place).size();
    const bool fits = a.offset <= bytes && bytes_each <= bytes - a.offset &&
                      (bytes - a.offset - bytes_each) / a.stride >= elements.count - 1;
    document_.require(
        fits, place,
        "a count of {} elements of {} bytes, {} apart, from byteOffset {} within bufferView {} of byteLength {}",
        elements.count, bytes_each, a.stride, a.offset, a.buffer, bytes);
}

Accessors::Elements Accessors::elements(int index, const Wanted& wanted, std::string_view place) const {
    const tinygltf::Accessor& accessor = get(index, place);
    const auto type = component_type(accessor.componentType);
    const std::uint8_t components = components_of(accessor.type);
    document_.require(type.has_value(), place, "a component type of glTF 2.0, got {}", accessor.componentType);
    document_.require(accessor.count >= 1, place, "at least one element");
    if (wanted.matrix)
        document_.require(accessor.type == TINYGLTF_TYPE_MAT4 && type == ComponentType::f32, place,
                          "4x4 matrices of floats");
    else
        document_.require(components >= wanted.least_components && components <= wanted.most_components, place,
                          "{} components, got {}", wanted.components_text(), components);
    Elements result;
    result.count = accessor.count;
    result.attribute.type = *type;
    result.attribute.components = wanted.matrix ? std::uint8_t{4} : components; // a matrix is read column by column
    result.attribute.normalized = accessor.normalized || (wanted.normalized && type != ComponentType::f32);
    if (accessor.bufferView < 0) {
        document_.require(accessor.count <= most_zeros, place, "at most {} elements without data, got {}", most_zeros,
                          accessor.count);
        return result;
    }
    const auto& view = document_.at(document_.model().bufferViews, accessor.bufferView, place, "bufferView");
    const std::uint32_t size = result.attribute.bytes() * (wanted.matrix ? 4 : 1);
    document_.require(view.byteStride == 0 || (view.byteStride >= size && view.byteStride <= 252), place,
                      "a byteStride of {} to 252 in bufferView {}, got {}", size, accessor.bufferView, view.byteStride);
    result.attribute.buffer = static_cast<std::uint32_t>(accessor.bufferView);
    result.attribute.offset = accessor.byteOffset;
    result.attribute.stride = view.byteStride == 0 ? size : static_cast<std::uint32_t>(view.byteStride);
    require_inside(result, size, place);
    return result;
}

std::vector<glm::vec4> Accessors::read(const Elements& elements, std::string_view place) const {
    const auto bytes = std::as_bytes(document_.view_bytes(static_cast<int>(elements.attribute.buffer), place));
    const pipeline::AttributeReader reader(bytes.data(), elements.attribute);
    std::vector<glm::vec4> values(elements.count);
    for (std::uint32_t i = 0; i < values.size(); ++i) values[i] = reader(i);
    return values;
}

bool Accessors::lies_in_file(int index, std::string_view place) const {
    const tinygltf::Accessor& accessor = get(index, place);
    return accessor.bufferView >= 0 && !accessor.sparse.isSparse;
}

std::uint32_t Accessors::buffer_of_view(std::uint32_t view, std::string_view place) {
    const auto [entry, is_new] = buffer_of_view_.try_emplace(view, static_cast<std::uint32_t>(buffers_.size()));
    if (is_new) {
        const auto bytes = std::as_bytes(document_.view_bytes(static_cast<int>(view), place));
        const auto& name = document_.model().bufferViews[view].name;
        buffers_.push_back({name.empty() ? fmt::format("bufferView {}", view) : name, {bytes.begin(), bytes.end()}, 0});
    }
    return entry->second;
}

VertexAttribute Accessors::in_place(int index, pipeline::Semantic semantic, const Wanted& wanted,
                                    std::string_view place) {
    VertexAttribute attribute = elements(index, wanted, place).attribute;
    attribute.semantic = semantic;
    attribute.buffer = buffer_of_view(attribute.buffer, place);
    return attribute;
}

// The sparse elements in their places (glTF 2.0, section 3.6.2.3).
void Accessors::overlay(std::vector<glm::vec4>& values, const tinygltf::Accessor& accessor, const Elements& base,
                        std::string_view place) const {
    const auto& sparse = accessor.sparse;
    const auto where = fmt::format("{} sparse", place);
    const auto type = component_type(sparse.indices.componentType);
    document_.require(type.has_value() && is_unsigned_integer(*type), where, "indices of an unsigned type, got {}",
                      sparse.indices.componentType);
    // Indices pass through floats, which are exact up to 2^24.
    document_.require(values.size() <= most_zeros, where, "a count of at most {}, got {}", most_zeros, values.size());
    document_.require(sparse.count >= 1 && static_cast<std::size_t>(sparse.count) <= values.size(), where,
                      "a count from 1 to {}, got {}", values.size(), sparse.count);
    const auto part = [&](int view, int offset, VertexAttribute attribute) {
        document_.require(view >= 0 && offset >= 0, where, "a bufferView and an offset of at least 0");
        attribute.buffer = static_cast<std::uint32_t>(view);
        attribute.offset = static_cast<std::uint64_t>(offset);
        attribute.stride = attribute.bytes();
        const Elements found{attribute, static_cast<std::size_t>(sparse.count)};
        require_inside(found, attribute.stride, where);
        return read(found, where);
    };
    VertexAttribute number;
    number.type = *type;
    number.components = 1;
    const auto targets = part(sparse.indices.bufferView, sparse.indices.byteOffset, number);
    const auto replaced = part(sparse.values.bufferView, sparse.values.byteOffset, base.attribute);
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const auto target = static_cast<std::size_t>(targets[i].x);
        document_.require(target < values.size(), where, "indices below {}, got {}", values.size(), target);
        values[target] = replaced[i];
    }
}

std::vector<glm::vec4> Accessors::floats(int index, const Wanted& wanted, std::string_view place) const {
    const Elements source = elements(index, wanted, place);
    const tinygltf::Accessor& accessor = get(index, place);
    const glm::vec4 zero(0.0F, 0.0F, 0.0F, source.attribute.components == 4 ? 0.0F : 1.0F);
    auto values = accessor.bufferView < 0 ? std::vector<glm::vec4>(source.count, zero) : read(source, place);
    if (accessor.sparse.isSparse) overlay(values, accessor, source, place);
    return values;
}

std::vector<glm::mat4> Accessors::matrices(int index, std::string_view place) const {
    document_.require(lies_in_file(index, place), place, "matrices that lie in a bufferView");
    Elements source = elements(index, {.matrix = true}, place);
    std::vector<glm::mat4> values(source.count);
    for (int column = 0; column < 4; ++column) {
        const std::vector<glm::vec4> columns = read(source, place);
        for (std::size_t i = 0; i < values.size(); ++i) values[i][column] = columns[i];
        source.attribute.offset += sizeof(glm::vec4);
    }
    return values;
}

VertexAttribute Accessors::computed_indices(int index, std::string_view place) {
    constexpr float exact = 0x1p24F; // indices pass through floats
    const Wanted one{.least_components = 1, .most_components = 1};
    const VertexAttribute source = elements(index, one, place).attribute;
    document_.require(is_unsigned_integer(source.type) && !source.normalized, place, "unsigned integers");
    std::vector<std::uint32_t> indices;
    for (const glm::vec4& value : floats(index, one, place)) {
        document_.require(value.x < exact, place, "sparse indices below {}, got {}", exact, value.x);
        indices.push_back(static_cast<std::uint32_t>(value.x));
    }
    VertexAttribute attribute;
    attribute.type = ComponentType::u32;
    attribute.components = 1;
    attribute.stride = attribute.bytes();
    attribute.buffer = add_buffer<std::uint32_t>(std::string(place), indices);
    return attribute;
}

VertexAttribute Accessors::indices_in_place(int index, std::string_view place) {
    if (!lies_in_file(index, place)) return computed_indices(index, place);
    const VertexAttribute attribute = in_place(index, {}, {.least_components = 1, .most_components = 1}, place);
    document_.require(is_unsigned_integer(attribute.type) && !attribute.normalized, place, "unsigned integers");
    document_.require(attribute.stride == attribute.bytes(), place, "indices without gaps");
    return attribute;
}

} // namespace traces::gltf
