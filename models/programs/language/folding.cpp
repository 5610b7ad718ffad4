#include "models/programs/language/folding.hpp"

#include "models/programs/language/arithmetic.hpp"
#include "sim/check.hpp"

namespace models::language {

namespace {

float truth(bool value) { return value ? 1.0F : 0.0F; }

} // namespace

float fold(Operation operation, Type type, const std::array<float, 3>& operands) {
    const auto [a, b, c] = operands;
    const auto typed = [type](float result) { return type == Type::integer ? truncated(result) : finite(result); };
    switch (operation) {
    case Operation::negate:
        return -a;
    case Operation::invert:
        return 1.0F - a;
    case Operation::add:
        return typed(a + b);
    case Operation::subtract:
        return typed(a - b);
    case Operation::multiply:
        return typed(a * b);
    case Operation::divide:
        return type == Type::integer ? whole_quotient(a, b) : quotient(a, b);
    case Operation::less:
        return truth(a < b);
    case Operation::less_or_equal:
        return truth(a <= b);
    case Operation::greater:
        return truth(a > b);
    case Operation::greater_or_equal:
        return truth(a >= b);
    case Operation::equal:
        return truth(a == b);
    case Operation::not_equal:
        return truth(a != b);
    case Operation::both:
    case Operation::least:
        return std::min(a, b);
    case Operation::either:
    case Operation::greatest:
        return std::max(a, b);
    case Operation::magnitude:
        return std::abs(a);
    case Operation::truncate:
        return truncated(a);
    case Operation::choose:
        return a != 0.0F ? b : c;
    }
    CHECK(false);
}

} // namespace models::language
