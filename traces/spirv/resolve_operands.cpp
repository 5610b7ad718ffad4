// What operands are, and where they lie.
#include "traces/spirv/resolver.hpp"

#include <fmt/format.h>

namespace traces::spirv {

void Resolver::spend(const Instruction& user, std::uint64_t work) {
    constexpr std::uint64_t most = 1ULL << 25U; // well below a second
    spent_ += work;
    require(spent_ <= most, user, "expected a smaller shader, with its calls put in place");
}

Slot Resolver::allocate(const Instruction& user, std::uint32_t count) {
    require(count <= most_slots - slots_, user,
            fmt::format("expected a shader that needs {} registers or fewer", most_slots));
    const Slot first = static_cast<Slot>(slots_);
    slots_ += count;
    return first;
}

Slot Resolver::allocate_fixed(const Instruction& user, std::uint32_t count) {
    const std::size_t used = program_.constants.size();
    require(count <= most_slots - used, user, fmt::format("expected {} constants or fewer", most_slots));
    program_.constants.resize(used + count);
    return -static_cast<Slot>(used + count);
}

Slot Resolver::fixed(const Instruction& user, std::span<const std::uint32_t> scalars) {
    const Slot first = allocate_fixed(user, static_cast<std::uint32_t>(scalars.size()));
    const std::size_t last = program_.constants.size() - 1; // slots go up, places in the list go down
    for (std::size_t i = 0; i < scalars.size(); ++i) program_.constants[last - i] = scalars[i];
    return first;
}

Resolver::Value Resolver::constant(Id id, const Instruction& user) {
    const Constant& constant = module_.constant(id, user);
    const auto found = constants_.find(id);
    const Slot slot = found != constants_.end() ? found->second : fixed(user, constant.scalars);
    constants_[id] = slot;
    return {Is::registers, constant.type, slot, 0};
}

Resolver::Value Resolver::value(const Instruction& instruction, std::uint32_t i) {
    const Id id = operand(instruction, i);
    if (module_.names(id) == Names::constant) return constant(id, instruction);
    if (id >= values_.size() || values_[id].is == Is::nothing)
        fail(instruction, fmt::format("expected id {} to be defined before it is used", id));
    return values_[id];
}

Resolver::Value Resolver::registers(const Instruction& instruction, std::uint32_t i) {
    const Value found = value(instruction, i);
    if (found.is != Is::registers)
        fail(instruction, fmt::format("expected id {} to be a value, got a {}", operand(instruction, i),
                                      found.is == Is::pointer ? "pointer" : "texture"));
    return found;
}

Kind Resolver::scalar_kind(const Type& of) const { return of.kind == Kind::vector ? type(of.element).kind : of.kind; }

std::uint32_t Resolver::components(const Instruction& instruction, Id id) const {
    const Type& of = type(id);
    require(of.scalar() || of.kind == Kind::vector, instruction, "expected a scalar or a vector");
    return of.scalars;
}

void Resolver::check_kind(const Instruction& instruction, Id id, char kind, std::uint32_t count,
                          std::string_view what) const {
    const Type& of = type(id);
    const Kind is = scalar_kind(of);
    const bool whole = is == Kind::whole || is == Kind::natural, real = is == Kind::real, truth = is == Kind::truth;
    const bool fits = kind == 'r' ? real : kind == 'i' ? whole : kind == 'b' ? truth : real || whole || truth;
    const std::string_view words = kind == 'r'   ? "floats"
                                   : kind == 'i' ? "whole numbers"
                                   : kind == 'b' ? "truths"
                                                 : "scalars";
    if (!fits || of.scalars != count)
        fail(instruction,
             fmt::format("expected {} to be {} {}, got {} of another type or number", what, count, words, of.scalars));
}

Slot Resolver::lanes(const Instruction& instruction, std::uint32_t i, char kind, std::uint32_t count) {
    const Value found = registers(instruction, i);
    check_kind(instruction, found.type, kind, count, fmt::format("id {}", operand(instruction, i)));
    return found.slot;
}

Slot Resolver::define(const Instruction& instruction) {
    const std::uint32_t count = type(instruction.type).scalars;
    require(count > 0, instruction, "expected a result that is a value");
    const Slot slot = allocate(instruction, count);
    define_as(instruction, {Is::registers, instruction.type, slot, 0});
    return slot;
}

void Resolver::define_as(const Instruction& instruction, Value value) { values_[instruction.id] = value; }

} // namespace traces::spirv
