// Types and meanings within expressions.
#pragma once

#include "models/programs/language/scope.hpp"

namespace models::language {

/// Where an expression stands decides what it may read.
enum class Context : std::uint8_t {
    constants, ///< initial values: nothing that is known only when fragments arrive
    shader,    ///< the entry line: the shader's results
    fragment,
    drain ///< everything but the fragment
};

std::string_view name_of(Type type);

class ExpressionChecker {
  public:
    ExpressionChecker(const Program& program, const Scope& scope) : program_(program), scope_(scope) {}

    void check(Expression& expression, Context context) const;
    /// Complains unless a value of this expression can be stored as `type`; a whole number can as a number.
    void require(const Expression& expression, Type type) const;

  private:
    void check_operation(Expression& expression, Context context) const;
    void check_reference(Expression& expression, Context context) const;
    void check_name(Expression& expression) const;
    void check_entry(Expression& expression, Context context) const;
    void check_fragment(Expression& expression, Context context) const;
    std::uint32_t field_of(const std::vector<Definition>& fields, const Expression& expression) const;
    Type arithmetic(const Expression& left, const Expression& right) const;

    const Program& program_;
    const Scope& scope_;
};

} // namespace models::language
