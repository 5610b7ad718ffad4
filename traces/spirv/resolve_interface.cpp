// Variables outside of functions: inputs, outputs, uniforms, textures.
#include "traces/spirv/resolver.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace traces::spirv {

namespace {

std::uint32_t locations_of(const Module& module, const Type& type) {
    switch (type.kind) {
    case Kind::array:
        return type.count * locations_of(module, module.type(type.element));
    case Kind::matrix:
        return type.count;
    default:
        return 1;
    }
}

} // namespace

void Resolver::variables() {
    const auto each = [&](auto wanted, auto use) {
        for (const Variable& variable : module_.variables())
            if (wanted(variable.storage)) use(variable);
    };
    // Inputs come first: a run does not clear them.
    each([](Storage s) { return s == Storage::input; }, [&](const Variable& v) { interface_variable(v, true); });
    program_.kept_slots = slots_;
    each([](Storage s) { return s == Storage::output || s == Storage::invocation; },
         [&](const Variable& v) { interface_variable(v, false); });
    each([](Storage s) { return s != Storage::input && s != Storage::output && s != Storage::invocation; },
         [&](const Variable& v) { uniform_variable(v); });
}

InterfaceVariable Resolver::described(const Type& of, std::string name, const Decorations& decorations,
                                      Slot slot) const {
    InterfaceVariable made;
    made.name = std::move(name);
    made.decorations = decorations;
    made.slot = slot;
    const Type* inner = &of;
    for (; inner->kind == Kind::array; inner = &type(inner->element)) made.elements *= inner->count;
    if (inner->kind == Kind::matrix) {
        made.columns = inner->count;
        inner = &type(inner->element);
    }
    made.components = inner->scalars;
    made.kind = scalar_kind(*inner);
    return made;
}

void Resolver::interface_variable(const Variable& variable, bool input) {
    const Instruction user{Op::variable, variable.word, 0, 0, 0, 0};
    const Type& of = type(variable.type);
    require(of.scalars > 0, user, "expected a variable that holds a value");
    const Slot slot = allocate(user, of.scalars);
    pointers_.push_back({variable.storage, false, input, slot});
    values_[variable.id] = {Is::pointer, variable.pointer, 0, static_cast<std::uint32_t>(pointers_.size() - 1)};
    if (variable.initial != 0 && !input) initialise(user, slot, variable.initial);
    const std::vector<Id>& interface = program_.entry.interface;
    if (variable.storage == Storage::invocation ||
        std::find(interface.begin(), interface.end(), variable.id) == interface.end())
        return;
    std::vector<InterfaceVariable>& list = input ? program_.inputs : program_.outputs;
    const Decorations& own = module_.decorations(variable.id);
    const std::string name = module_.name(variable.id);
    if (of.kind != Kind::structure) return list.push_back(described(of, name, own, slot));
    Slot at = slot;
    std::optional<std::uint32_t> location = own.location;
    for (const Member& member : of.members) {
        const Type& part = type(member.type);
        Decorations decorations = member.decorations;
        decorations.flat |= own.flat;
        decorations.no_perspective |= own.no_perspective;
        if (!decorations.location && !decorations.built_in) decorations.location = location;
        if (decorations.location) location = *decorations.location + locations_of(module_, part);
        list.push_back(
            described(part, of.block || name.empty() ? member.name : name + "." + member.name, decorations, at));
        at += static_cast<Slot>(part.scalars);
    }
}

void Resolver::uniform_variable(const Variable& variable) {
    const Type& of = type(variable.type);
    if (of.opaque() || (of.kind == Kind::array && type(of.element).opaque())) return texture_variable(variable);
    const Instruction user{Op::variable, variable.word, 0, 0, 0, 0};
    require(
        variable.storage == Storage::uniform || variable.storage == Storage::uniform_constant ||
            variable.storage == Storage::push_constant,
        user,
        fmt::format("expected a storage class that is modelled, got {}", static_cast<std::uint32_t>(variable.storage)));
    require(of.scalars > 0 && !of.buffer, user, "expected uniforms, got a storage buffer or something without a value");
    UniformVariable made;
    const std::string name = module_.name(variable.id);
    made.block = variable.storage != Storage::uniform_constant;
    made.name = name.empty() || made.block ? module_.name(variable.type) : name;
    made.decorations = module_.decorations(variable.id);
    made.type = variable.type;
    made.first = program_.uniform_words;
    const Layout layout{made.block, 0, false};
    made.words = extent(module_, of, layout, user);
    require(made.words <= most_uniform_words - program_.uniform_words, user,
            fmt::format("expected uniforms of {} words or fewer in all", most_uniform_words));
    program_.uniform_words += made.words;
    pointers_.push_back({variable.storage, true, true, made.first, 1, layout});
    values_[variable.id] = {Is::pointer, variable.pointer, 0, static_cast<std::uint32_t>(pointers_.size() - 1)};
    program_.uniforms.push_back(std::move(made));
}

void Resolver::texture_variable(const Variable& variable) {
    const Type& of = type(variable.type);
    const Type& single = of.kind == Kind::array ? type(of.element) : of;
    Pointer pointer{variable.storage, false, true, 0};
    pointer.texture = static_cast<std::uint32_t>(program_.textures.size());
    pointers_.push_back(pointer);
    values_[variable.id] = {Is::pointer, variable.pointer, 0, static_cast<std::uint32_t>(pointers_.size() - 1)};
    program_.textures.push_back({module_.name(variable.id), module_.decorations(variable.id), single.kind, single.image,
                                 of.kind == Kind::array ? of.count : 1});
}

} // namespace traces::spirv
