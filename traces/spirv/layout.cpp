#include "traces/spirv/layout.hpp"

#include "traces/spirv/program.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace traces::spirv {

std::uint32_t element_stride(const Module& module, const Type& array, const Layout& layout) {
    return layout.declared ? array.stride / 4 : module.type(array.element).scalars;
}

std::uint32_t column_stride(const Type& matrix, const Layout& layout) {
    if (!layout.declared) return matrix.scalars / matrix.count;
    return layout.row_major ? 1 : layout.matrix_stride;
}

std::uint32_t component_stride(const Layout& layout) {
    return layout.declared && layout.row_major ? layout.matrix_stride : 1;
}

std::uint32_t member_offset(const Type& structure, std::uint32_t i, Layout& layout) {
    const Decorations& decorations = structure.members[i].decorations;
    layout.matrix_stride = decorations.matrix_stride.value_or(0) / 4;
    layout.row_major = decorations.row_major;
    return layout.declared ? decorations.offset.value_or(0) / 4 : structure.members[i].first;
}

namespace {

constexpr std::uint64_t too_far = most_uniform_words + 1ULL;

std::uint64_t extent_of(const Module& module, const Type& type, const Layout& layout, const Instruction& user) {
    const auto span = [&](std::uint32_t count, std::uint64_t stride, std::uint64_t part) {
        return std::min(too_far, (count - 1) * stride + part);
    };
    switch (type.kind) {
    case Kind::structure: {
        std::uint64_t end = 0;
        for (std::uint32_t i = 0; i < type.count; ++i) {
            const Decorations& place = type.members[i].decorations;
            if (layout.declared &&
                (!place.offset || *place.offset % 4 != 0 || place.matrix_stride.value_or(0) % 4 != 0))
                fail(user, fmt::format("expected an offset in whole words for member {} of a block", i));
            Layout inner = layout;
            const std::uint64_t offset = member_offset(type, i, inner);
            end = std::max(end, offset + extent_of(module, module.type(type.members[i].type), inner, user));
        }
        return std::min(too_far, end);
    }
    case Kind::array:
        if (layout.declared && (type.stride == 0 || type.stride % 4 != 0))
            fail(user, "expected an array stride of whole words in a block");
        return span(type.count, element_stride(module, type, layout),
                    extent_of(module, module.type(type.element), layout, user));
    case Kind::matrix: {
        if (layout.declared && layout.matrix_stride == 0) fail(user, "expected a matrix stride in a block");
        const std::uint32_t rows = type.scalars / type.count;
        return span(type.count, column_stride(type, layout), span(rows, component_stride(layout), 1));
    }
    default:
        return type.scalars;
    }
}

} // namespace

std::uint32_t extent(const Module& module, const Type& type, const Layout& layout, const Instruction& user) {
    const std::uint64_t words = extent_of(module, type, layout, user);
    if (words > most_uniform_words)
        fail(user, fmt::format("expected uniforms of {} words or fewer", most_uniform_words));
    return static_cast<std::uint32_t>(words);
}

void place_scalars(const Module& module, const Type& type, const Layout& layout, std::uint32_t base,
                   std::vector<PlacedScalar>& places) {
    switch (type.kind) {
    case Kind::structure:
        for (std::uint32_t i = 0; i < type.count; ++i) {
            Layout inner = layout;
            const std::uint32_t offset = member_offset(type, i, inner);
            place_scalars(module, module.type(type.members[i].type), inner, base + offset, places);
        }
        return;
    case Kind::array:
        for (std::uint32_t i = 0; i < type.count; ++i)
            place_scalars(module, module.type(type.element), layout, base + i * element_stride(module, type, layout),
                          places);
        return;
    case Kind::matrix: {
        const std::uint32_t rows = type.scalars / type.count;
        for (std::uint32_t column = 0; column < type.count; ++column)
            for (std::uint32_t row = 0; row < rows; ++row)
                places.push_back({base + column * column_stride(type, layout) + row * component_stride(layout), false});
        return;
    }
    case Kind::vector:
        for (std::uint32_t i = 0; i < type.count; ++i)
            places.push_back({base + i, module.type(type.element).kind == Kind::truth});
        return;
    default:
        places.push_back({base, type.kind == Kind::truth});
        return;
    }
}

} // namespace traces::spirv
