#include "models/programs/language/expression_parser.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace models::language {

namespace {

struct Operator {
    std::string_view text;
    Operation operation;
};

/// Binary operators, weakest first; compares do not chain.
const std::array<std::vector<Operator>, 5> levels{{
    {{"or", Operation::either}},
    {{"and", Operation::both}},
    {{"<", Operation::less},
     {"<=", Operation::less_or_equal},
     {">", Operation::greater},
     {">=", Operation::greater_or_equal},
     {"==", Operation::equal},
     {"!=", Operation::not_equal}},
    {{"+", Operation::add}, {"-", Operation::subtract}},
    {{"*", Operation::multiply}, {"/", Operation::divide}},
}};
constexpr std::size_t compares = 2;

struct Function {
    std::string_view name;
    Operation operation;
    std::size_t operands;
};

constexpr std::array<Function, 5> functions{{{"min", Operation::least, 2},
                                             {"max", Operation::greatest, 2},
                                             {"abs", Operation::magnitude, 1},
                                             {"int", Operation::truncate, 1},
                                             {"select", Operation::choose, 3}}};

} // namespace

Expression ExpressionParser::expression() {
    if (++nesting_ > deepest_nesting) tokens_.fail(fmt::format("at most {} nested expressions", deepest_nesting));
    Expression result = level(0);
    --nesting_;
    return result;
}

Expression ExpressionParser::level(std::size_t precedence) {
    if (precedence == levels.size()) return unary();
    Expression left = level(precedence + 1);
    for (;;) {
        const auto& operators = levels[precedence];
        const auto found = std::find_if(operators.begin(), operators.end(),
                                        [&](const Operator& one) { return tokens_.sees(one.text); });
        if (found == operators.end()) return left;
        const Place place = tokens_.take().place;
        std::vector<Expression> operands;
        operands.push_back(std::move(left));
        operands.push_back(level(precedence + 1));
        left = operation(found->operation, std::move(operands), place);
        if (precedence == compares) return left;
    }
}

Expression ExpressionParser::unary() {
    const bool inverts = tokens_.sees("not");
    if (!inverts && !tokens_.sees("-")) return primary();
    const Place place = tokens_.take().place;
    if (++nesting_ > deepest_nesting) tokens_.fail(fmt::format("at most {} nested expressions", deepest_nesting));
    std::vector<Expression> operands;
    operands.push_back(inverts ? level(compares) : unary());
    --nesting_;
    return operation(inverts ? Operation::invert : Operation::negate, std::move(operands), place);
}

Expression ExpressionParser::operation(Operation kind, std::vector<Expression> operands, Place place) {
    Expression result;
    result.place = place;
    result.kind = Expression::Kind::operation;
    result.operation = kind;
    for (const Expression& operand : operands) result.depth = std::max(result.depth, operand.depth + 1);
    if (result.depth > deepest_nesting)
        tokens_.fail(fmt::format("an expression of at most {} operations in a chain", deepest_nesting));
    result.operands = std::move(operands);
    return result;
}

Expression ExpressionParser::call(Operation kind, std::size_t count, Place place) {
    tokens_.expect("(");
    std::vector<Expression> operands;
    for (std::size_t i = 0; i < count; ++i) {
        if (i > 0) tokens_.expect(",");
        operands.push_back(expression());
    }
    tokens_.expect(")");
    return operation(kind, std::move(operands), place);
}

Expression ExpressionParser::primary() {
    const Token& token = tokens_.peek();
    if (token.kind == TokenKind::integer || token.kind == TokenKind::number || tokens_.sees("true") ||
        tokens_.sees("false")) {
        Expression literal;
        literal.place = token.place;
        literal.type = token.kind == TokenKind::integer  ? Type::integer
                       : token.kind == TokenKind::number ? Type::number
                                                         : Type::boolean;
        literal.value = literal.type == Type::boolean ? (token.text == "true" ? 1.0 : 0.0) : token.value;
        tokens_.take();
        return literal;
    }
    if (tokens_.accept("(")) {
        Expression inner = expression();
        tokens_.expect(")");
        return inner;
    }
    for (const Function& function : functions)
        if (tokens_.sees(function.name)) {
            const Place place = tokens_.take().place;
            return call(function.operation, function.operands, place);
        }
    if (token.kind != TokenKind::word) tokens_.fail("an expression");
    return reference();
}

Expression ExpressionParser::reference() {
    const Token word = tokens_.expect(TokenKind::word, "a name");
    Expression result;
    result.place = word.place;
    result.kind = Expression::Kind::reference;
    result.name = word.text;
    if (word.text == "e") {
        tokens_.expect("[");
        result.operands.push_back(expression());
        tokens_.expect("]");
        result.depth += result.operands.front().depth;
        if (result.depth > deepest_nesting)
            tokens_.fail(fmt::format("an expression of at most {} operations in a chain", deepest_nesting));
    }
    const bool has_fields = word.text == "e" || word.text == "f" || word.text == "s";
    if (word.text == "s") tokens_.expect(".");
    if (word.text == "s" || (has_fields && tokens_.accept(".")))
        result.field = tokens_.expect(TokenKind::word, "a field").text;
    return result;
}

} // namespace models::language
