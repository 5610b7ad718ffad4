// What a program says about its border.
#include "traces/spirv/program.hpp"

#include "traces/spirv/layout.hpp"

#include <algorithm>
#include <charconv>

namespace traces::spirv {

namespace {

const InterfaceVariable* named(const std::vector<InterfaceVariable>& list, std::string_view name) {
    const auto found =
        std::find_if(list.begin(), list.end(), [&](const InterfaceVariable& v) { return v.name == name; });
    return found != list.end() ? &*found : nullptr;
}

/// A step of a path: "name", or the number in "[2]".
struct Step {
    std::string_view name;
    std::optional<std::uint32_t> index{};
};

std::optional<std::vector<Step>> steps_of(std::string_view path) {
    std::vector<Step> steps;
    while (!path.empty()) {
        if (path.front() == '[') {
            const std::size_t end = path.find(']');
            if (end == std::string_view::npos) return std::nullopt;
            std::uint32_t index = 0;
            const auto [last, error] = std::from_chars(path.data() + 1, path.data() + end, index);
            if (error != std::errc() || last != path.data() + end) return std::nullopt;
            steps.push_back({{}, index});
            path.remove_prefix(end + 1);
        } else {
            if (path.front() == '.') path.remove_prefix(1);
            const std::size_t end = std::min(path.find_first_of(".["), path.size());
            if (end == 0) return std::nullopt;
            steps.push_back({path.substr(0, end), {}});
            path.remove_prefix(end);
        }
    }
    return steps;
}

} // namespace

const InterfaceVariable* Program::input(std::string_view name) const { return named(inputs, name); }
const InterfaceVariable* Program::output(std::string_view name) const { return named(outputs, name); }

const InterfaceVariable* Program::built_in(std::uint32_t number) const {
    for (const auto* list : {&inputs, &outputs})
        for (const InterfaceVariable& variable : *list)
            if (variable.decorations.built_in == number) return &variable;
    return nullptr;
}

std::optional<UniformPlace> Program::uniform(const Module& module, std::string_view path) const {
    const std::optional<std::vector<Step>> steps = steps_of(path);
    if (!steps || steps->empty()) return std::nullopt;
    const auto found = std::find_if(uniforms.begin(), uniforms.end(),
                                    [&](const UniformVariable& u) { return u.name == steps->front().name; });
    if (found == uniforms.end()) return std::nullopt;
    UniformPlace place;
    place.first = found->first;
    Layout layout{found->block, 0, false};
    const Type* type = &module.type(found->type);
    for (std::size_t i = 1; i < steps->size(); ++i) {
        const Step& step = (*steps)[i];
        if (step.index) {
            if (type->kind != Kind::array || *step.index >= type->count) return std::nullopt;
            place.first += *step.index * element_stride(module, *type, layout);
            type = &module.type(type->element);
        } else {
            if (type->kind != Kind::structure) return std::nullopt;
            std::uint32_t member = 0;
            while (member < type->count && type->members[member].name != step.name) ++member;
            if (member == type->count) return std::nullopt;
            place.first += member_offset(*type, member, layout);
            type = &module.type(type->members[member].type);
        }
    }
    if (type->kind == Kind::array) {
        place.elements = type->count;
        place.element_stride = element_stride(module, *type, layout);
        type = &module.type(type->element);
    }
    if (type->kind == Kind::matrix) {
        place.columns = type->count;
        place.column_stride = column_stride(*type, layout);
        place.stride = component_stride(layout);
        type = &module.type(type->element);
    }
    if (!type->scalar() && type->kind != Kind::vector) return std::nullopt;
    place.components = type->scalars;
    place.kind = type->scalar() ? type->kind : module.type(type->element).kind;
    return place;
}

} // namespace traces::spirv
