#include "models/programs/language/expression_checker.hpp"

#include "sim/suggest.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace models::language {

namespace {

std::string text_of(const Expression& expression) {
    return expression.field.empty() ? expression.name : fmt::format("{}.{}", expression.name, expression.field);
}

} // namespace

std::string_view name_of(Type type) {
    switch (type) {
    case Type::number:
        return "a number";
    case Type::integer:
        return "a whole number";
    case Type::boolean:
        return "true or false";
    case Type::entry:
        break;
    }
    return "an entry";
}

void ExpressionChecker::require(const Expression& expression, Type type) const {
    if (expression.type == type || (type == Type::number && expression.type == Type::integer)) return;
    complain(program_.source, expression.place, name_of(type), name_of(expression.type));
}

Type ExpressionChecker::arithmetic(const Expression& left, const Expression& right) const {
    require(left, Type::number);
    require(right, Type::number);
    return left.type == Type::integer && right.type == Type::integer ? Type::integer : Type::number;
}

void ExpressionChecker::check(Expression& expression, Context context) const {
    switch (expression.kind) {
    case Expression::Kind::literal:
        expression.constant = true;
        break;
    case Expression::Kind::operation:
        check_operation(expression, context);
        break;
    case Expression::Kind::reference:
        check_reference(expression, context);
        if (context == Context::constants && !expression.constant)
            complain(program_.source, expression.place, "a constant", fmt::format("'{}'", text_of(expression)));
        break;
    }
}

void ExpressionChecker::check_operation(Expression& expression, Context context) const {
    std::vector<Expression>& operands = expression.operands;
    for (Expression& operand : operands) check(operand, context);
    expression.constant = std::all_of(operands.begin(), operands.end(), [](const auto& one) { return one.constant; });
    switch (expression.operation) {
    case Operation::invert:
    case Operation::both:
    case Operation::either:
        for (const Expression& operand : operands) require(operand, Type::boolean);
        expression.type = Type::boolean;
        break;
    case Operation::negate:
    case Operation::magnitude:
        expression.type = arithmetic(operands[0], operands[0]);
        break;
    case Operation::truncate:
        require(operands[0], Type::number);
        expression.type = Type::integer;
        break;
    case Operation::equal:
    case Operation::not_equal:
        if (operands[0].type == Type::boolean)
            require(operands[1], Type::boolean);
        else
            arithmetic(operands[0], operands[1]);
        expression.type = Type::boolean;
        break;
    case Operation::less:
    case Operation::less_or_equal:
    case Operation::greater:
    case Operation::greater_or_equal:
        arithmetic(operands[0], operands[1]);
        expression.type = Type::boolean;
        break;
    case Operation::choose:
        require(operands[0], Type::boolean);
        expression.type = operands[1].type;
        if (expression.type == Type::boolean)
            require(operands[2], Type::boolean);
        else
            expression.type = arithmetic(operands[1], operands[2]);
        break;
    default:
        expression.type = arithmetic(operands[0], operands[1]);
    }
}

void ExpressionChecker::check_reference(Expression& expression, Context context) const {
    if (expression.name == "e") return check_entry(expression, context);
    if (expression.name == "f") return check_fragment(expression, context);
    if (expression.name == "s") {
        if (context == Context::shader)
            complain(program_.source, expression.place, "a field of the shaded fragment or a constant", "'s'");
        expression.meaning = Meaning::of_state;
        expression.slot = field_of(program_.state, expression);
        return;
    }
    check_name(expression);
}

void ExpressionChecker::check_name(Expression& expression) const {
    if (expression.name == "k" || expression.name == "largest") {
        expression.meaning = expression.name == "k" ? Meaning::entries : Meaning::largest;
        expression.type = expression.name == "k" ? Type::integer : Type::number;
        expression.constant = true;
        return;
    }
    const Binding* binding = scope_.find(expression.name);
    if (binding == nullptr) {
        std::vector<std::string> known = scope_.names();
        known.insert(known.end(), {"k", "largest"});
        complain(program_.source, expression.place, "a name that is declared",
                 fmt::format("'{}'{}", expression.name, sim::did_you_mean(expression.name, known)));
    }
    expression.meaning = binding->meaning;
    expression.type = binding->type;
    expression.slot = binding->slot;
    expression.constant = binding->meaning != Meaning::variable;
}

void ExpressionChecker::check_entry(Expression& expression, Context context) const {
    if (context == Context::shader)
        complain(program_.source, expression.place, "a field of the shaded fragment or a constant", "'e'");
    Expression& index = expression.operands.front();
    check(index, context);
    require(index, Type::integer);
    expression.meaning = Meaning::of_entry;
    expression.type = expression.field.empty() ? Type::entry : Type::number;
    if (!expression.field.empty()) expression.slot = field_of(program_.entry, expression);
}

void ExpressionChecker::check_fragment(Expression& expression, Context context) const {
    if (context == Context::drain)
        complain(program_.source, expression.place, "an entry or the state: there is no fragment in a drain", "'f'");
    expression.meaning = Meaning::fragment;
    if (context == Context::shader) {
        const auto found = std::find(std::begin(shader_fields), std::end(shader_fields), expression.field);
        if (found == std::end(shader_fields))
            complain(program_.source, expression.place,
                     fmt::format("a field of the shaded fragment ({})", fmt::join(shader_fields, ", ")),
                     fmt::format("'{}'", expression.field.empty() ? expression.name : expression.field));
        expression.slot = static_cast<std::uint32_t>(found - std::begin(shader_fields));
        return;
    }
    expression.type = expression.field.empty() ? Type::entry : Type::number;
    if (!expression.field.empty()) expression.slot = field_of(program_.entry, expression);
}

std::uint32_t ExpressionChecker::field_of(const std::vector<Definition>& fields, const Expression& expression) const {
    std::vector<std::string> known;
    for (const Definition& field : fields) known.push_back(field.name);
    const auto found = std::find(known.begin(), known.end(), expression.field);
    if (found == known.end())
        complain(program_.source, expression.place,
                 known.empty() ? std::string("no field: the program declares no state")
                               : fmt::format("a field of the {} ({})", expression.name == "s" ? "state" : "entry",
                                             fmt::join(known, ", ")),
                 fmt::format("'{}'{}", text_of(expression), sim::did_you_mean(expression.field, known)));
    return static_cast<std::uint32_t>(found - known.begin());
}

} // namespace models::language
