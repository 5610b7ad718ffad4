// Expressions and the places that can be assigned to.
#pragma once

#include "models/programs/language/syntax.hpp"
#include "models/programs/language/token_stream.hpp"

namespace models::language {

/// Deepest nesting of expressions, and of blocks. Everything that walks a tree does so recursively.
inline constexpr std::uint32_t deepest_nesting = 64;

class ExpressionParser {
  public:
    explicit ExpressionParser(TokenStream& tokens) : tokens_(tokens) {}

    Expression expression();
    /// A name, s.field, f, f.field, e[index] or e[index].field.
    Expression reference();

  private:
    Expression level(std::size_t precedence);
    Expression unary();
    Expression primary();
    Expression call(Operation operation, std::size_t operands, Place place);
    Expression operation(Operation operation, std::vector<Expression> operands, Place place);

    TokenStream& tokens_;
    std::uint32_t nesting_ = 0;
};

} // namespace models::language
