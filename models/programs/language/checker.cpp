#include "models/programs/language/checker.hpp"

#include "models/programs/language/expression_checker.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace models::language {

namespace {

constexpr std::string_view reserved[] = {
    "e",     "f",       "s",       "k",        "largest", "program", "entry", "empty", "state",  "constant", "depth",
    "order", "peeling", "picture", "fragment", "drain",   "float",   "int",   "bool",  "if",     "else",     "for",
    "in",    "swap",    "and",     "or",       "not",     "min",     "max",   "abs",   "select", "true",     "false"};

class Checker {
  public:
    explicit Checker(Program& program) : program_(program), expressions_(program, scope_) {}

    void run() {
        constants();
        entry();
        values(program_.empty, "the entry");
        for (const Definition& value : program_.empty) entry_slot(value.name, value.place);
        values(program_.state, "the state");
        depth();
        size();
        picture();
        block(program_.fragment, Context::fragment);
        block(program_.drain, Context::drain);
    }

  private:
    [[noreturn]] void fail(Place place, std::string_view expected, std::string_view got) const {
        complain(program_.source, place, expected, got);
    }

    void constants() {
        for (Definition& constant : program_.constants) {
            expressions_.check(constant.value, Context::constants);
            add({constant.name, Meaning::constant, constant.value.type, next_constant_++}, constant.place);
        }
    }

    void add(Binding binding, Place place) {
        if (std::find(std::begin(reserved), std::end(reserved), binding.name) != std::end(reserved))
            fail(place, "a name that is not a word of the language", fmt::format("'{}'", binding.name));
        if (scope_.find(binding.name) != nullptr)
            fail(place, "a name that is not taken", fmt::format("'{}'", binding.name));
        scope_.add(std::move(binding));
    }

    void unique(const std::vector<Definition>& fields, std::string_view of) const {
        for (std::size_t i = 0; i < fields.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (fields[j].name == fields[i].name)
                    fail(fields[i].place, fmt::format("each field of {} once", of),
                         fmt::format("'{}' again", fields[i].name));
    }

    void entry() {
        if (program_.entry.empty() || program_.entry.size() > pipeline::largest_entry)
            fail(program_.entry.empty() ? Place{} : program_.entry.back().place,
                 fmt::format("an entry of 1 to {} fields", pipeline::largest_entry),
                 fmt::format("{}", program_.entry.size()));
        unique(program_.entry, "the entry");
        for (Definition& field : program_.entry) {
            expressions_.check(field.value, Context::shader);
            expressions_.require(field.value, Type::number);
            program_.needs_colour |= reads_colour(field.value);
        }
    }

    static bool reads_colour(const Expression& expression) {
        constexpr std::uint32_t channels = 4;
        if (expression.meaning == Meaning::fragment && expression.slot < channels) return true;
        return std::any_of(expression.operands.begin(), expression.operands.end(), reads_colour);
    }

    void values(std::vector<Definition>& fields, std::string_view of) const {
        unique(fields, of);
        for (Definition& field : fields) {
            expressions_.check(field.value, Context::constants);
            expressions_.require(field.value, Type::number);
        }
    }

    std::uint32_t entry_slot(const std::string& name, Place place) const {
        for (std::uint32_t i = 0; i < program_.entry.size(); ++i)
            if (program_.entry[i].name == name) return i;
        fail(place, "a field of the entry", fmt::format("'{}'", name));
    }

    void depth() { program_.depth_slot = entry_slot(program_.depth, program_.depth_place); }

    void size() const {
        const std::size_t floats = program_.most_k * program_.entry.size() + program_.state.size();
        const std::size_t targets = (floats + 3) / 4;
        if (targets > pipeline::most_targets)
            fail(program_.entry.front().place,
                 fmt::format("at most {} render targets of four floats for k = {}", pipeline::most_targets,
                             program_.most_k),
                 fmt::format("{}", targets));
    }

    void picture() const {
        if (program_.picture == Picture::layers) return;
        const bool of_state = program_.picture == Picture::state;
        const std::vector<Definition>& fields = of_state ? program_.state : program_.entry;
        for (const std::string_view name : {"r", "g", "b", "t"})
            if (std::none_of(fields.begin(), fields.end(), [&](const Definition& one) { return one.name == name; }))
                fail(program_.picture_place,
                     fmt::format("fields r, g, b and t in the {}", of_state ? "state" : "entry"),
                     fmt::format("none called '{}'", name));
    }

    void block(std::vector<Statement>& statements, Context context) {
        const std::size_t names = scope_.size();
        for (Statement& one : statements) statement(one, context);
        scope_.shrink(names);
    }

    void statement(Statement& one, Context context) {
        for (Expression& operand : one.operands) expressions_.check(operand, context);
        switch (one.kind) {
        case Statement::Kind::declare:
            expressions_.require(one.operands[0], one.type);
            one.slot = program_.variables++;
            add({one.name, Meaning::variable, one.type, one.slot}, one.place);
            break;
        case Statement::Kind::assign:
            target(one.operands[0]);
            expressions_.require(one.operands[1], one.operands[0].type);
            break;
        case Statement::Kind::swap:
            for (const Expression& operand : one.operands) target(operand);
            if (one.operands[0].type != one.operands[1].type)
                fail(one.operands[1].place, name_of(one.operands[0].type), name_of(one.operands[1].type));
            break;
        case Statement::Kind::branch:
            expressions_.require(one.operands[0], Type::boolean);
            block(one.body, context);
            block(one.otherwise, context);
            break;
        case Statement::Kind::loop:
            loop(one, context);
            break;
        }
    }

    void target(const Expression& expression) const {
        const bool stored = expression.meaning == Meaning::variable || expression.meaning == Meaning::of_entry ||
                            expression.meaning == Meaning::fragment || expression.meaning == Meaning::of_state;
        if (!stored)
            fail(expression.place, "a variable, an entry, the fragment or a field of the state",
                 fmt::format("'{}'", expression.name));
    }

    // Loops are unrolled, so their bounds are known when k is.
    void loop(Statement& one, Context context) {
        for (const Expression& bound : one.operands) {
            expressions_.require(bound, Type::integer);
            if (!bound.constant)
                fail(bound.place, "a bound that is known before the program runs", "a value that is not");
        }
        const std::size_t names = scope_.size();
        one.slot = program_.counters++;
        add({one.name, Meaning::counter, Type::integer, one.slot}, one.place);
        block(one.body, context);
        scope_.shrink(names);
    }

    Program& program_;
    Scope scope_;
    ExpressionChecker expressions_;
    std::uint32_t next_constant_ = 0;
};

} // namespace

void check(Program& program) { Checker(program).run(); }

} // namespace models::language
