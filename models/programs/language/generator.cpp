#include "models/programs/language/generator.hpp"

#include "models/programs/language/arithmetic.hpp"
#include "models/programs/language/emitter.hpp"
#include "models/programs/language/folding.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <optional>

namespace models::language {

namespace {

constexpr std::uint32_t most_rounds = 1U << 18; ///< of all unrolled loops of a program; 64 * 64 * 64

/// Where something that can be assigned to lies: at an operand, or in an entry whose number is computed.
struct Target {
    Operand operand = 0;
    std::optional<Operand> index;
    std::uint32_t field = 0, count = 1;
};

/// What is known before the program runs, and is the same for all its parts.
struct Setting {
    const Program& program;
    std::uint32_t k;
    std::vector<float> constants;

    std::uint32_t floats() const { return static_cast<std::uint32_t>(program.entry.size()); }
};

class Generator {
  public:
    Generator(const Setting& setting, std::uint32_t first_temporary)
        : setting_(setting),
          emitter_(setting.program.source, first_temporary),
          counters_(setting.program.counters, 0.0F) {}

    void block(const std::vector<Statement>& statements) {
        for (const Statement& one : statements) statement(one);
    }

    void store(const Expression& value, Operand to) {
        emitter_.begin_statement(value.place);
        evaluate_into(value, to);
    }

    /// A value that is known.
    float constant(const Expression& expression) {
        const Value value = evaluate(expression, {});
        CHECK(value.constant);
        return value.number;
    }

    Code take() {
        Code code = emitter_.take();
        code.entries = setting_.k;
        code.floats_per_entry = setting_.floats();
        return code;
    }

  private:
    Operand variable(std::uint32_t slot) const {
        const std::uint32_t place = setting_.floats() + slot;
        if (place >= most_locals)
            complain(setting_.program.source, {}, fmt::format("at most {} variables", most_locals), "more");
        return operand(Bank::locals, place);
    }

    void statement(const Statement& one) {
        emitter_.begin_statement(one.place);
        switch (one.kind) {
        case Statement::Kind::declare:
            evaluate_into(one.operands[0], variable(one.slot));
            break;
        case Statement::Kind::assign:
            assign(one);
            break;
        case Statement::Kind::swap:
            swap(target(one.operands[0]), target(one.operands[1]));
            break;
        case Statement::Kind::branch:
            branch(one);
            break;
        case Statement::Kind::loop:
            loop(one);
            break;
        }
    }

    void loop(const Statement& one) {
        const float end = constant(one.operands[1]);
        for (float i = constant(one.operands[0]); i < end; i += 1.0F) {
            if (++rounds_ > most_rounds)
                complain(setting_.program.source, one.place, fmt::format("at most {} rounds of loops", most_rounds),
                         "more");
            counters_[one.slot] = i;
            block(one.body);
        }
    }

    void branch(const Statement& one) {
        const Expression& condition = one.operands[0];
        if (condition.constant) return block(constant(condition) != 0.0F ? one.body : one.otherwise);
        const std::size_t skip = jump_unless(condition);
        block(one.body);
        if (one.otherwise.empty()) {
            if (!emitter_.join_swap(skip)) emitter_.aim(skip);
            return;
        }
        const std::size_t end = emitter_.emit_jump({Opcode::jump});
        emitter_.aim(skip);
        block(one.otherwise);
        emitter_.aim(end);
    }

    // Compares jump themselves.
    std::size_t jump_unless(const Expression& condition) {
        if (condition.kind == Expression::Kind::operation) {
            switch (condition.operation) {
            case Operation::less:
                return jump_unless(Opcode::unless_less, condition, 0, 1);
            case Operation::greater:
                return jump_unless(Opcode::unless_less, condition, 1, 0);
            case Operation::less_or_equal:
                return jump_unless(Opcode::unless_less_or_equal, condition, 0, 1);
            case Operation::greater_or_equal:
                return jump_unless(Opcode::unless_less_or_equal, condition, 1, 0);
            case Operation::equal:
                return jump_unless(Opcode::unless_equal, condition, 0, 1);
            case Operation::not_equal:
                return jump_unless(Opcode::unless_not_equal, condition, 0, 1);
            default:
                break;
            }
        }
        return emitter_.emit_jump({Opcode::jump_if_false, 1, 0, emitter_.read(evaluate(condition, {}))});
    }

    std::size_t jump_unless(Opcode code, const Expression& condition, std::size_t left, std::size_t right) {
        const Operand b = emitter_.read(evaluate(condition.operands[left], {}));
        const Operand c = emitter_.read(evaluate(condition.operands[right], {}));
        return emitter_.emit_jump({code, 1, 0, b, c});
    }

    void assign(const Statement& one) {
        const Target to = target(one.operands[0]);
        const Expression& value = one.operands[1];
        if (to.count > 1 || value.type == Type::entry) return copy(to, target(value));
        if (!to.index) return evaluate_into(value, to.operand);
        emitter_.emit({Opcode::store, 1, emitter_.read(evaluate(value, {})), *to.index, place(to.field)});
    }

    void copy(const Target& to, const Target& from) {
        if (!to.index && !from.index)
            return emitter_.emit({Opcode::move, static_cast<std::uint8_t>(to.count), to.operand, from.operand});
        for (std::uint32_t i = 0; i < to.count; ++i) put(to, i, get(from, i, {}));
    }

    void swap(const Target& a, const Target& b) {
        if (!a.index && !b.index)
            return emitter_.emit({Opcode::swap, static_cast<std::uint8_t>(a.count), a.operand, b.operand});
        for (std::uint32_t i = 0; i < a.count; ++i) {
            const Operand kept = emitter_.temporary();
            emitter_.emit({Opcode::move, 1, kept, get(a, i, {})});
            put(a, i, get(b, i, {}));
            put(b, i, kept);
        }
    }

    static Operand place(std::uint32_t number) { return static_cast<Operand>(number); }

    Operand get(const Target& from, std::uint32_t i, std::optional<Operand> into) {
        if (!from.index) return place(from.operand + i);
        const Operand to = into ? *into : emitter_.temporary();
        emitter_.emit({Opcode::load, 1, to, *from.index, place(from.field + i)});
        return to;
    }

    void put(const Target& to, std::uint32_t i, Operand value) {
        if (to.index)
            emitter_.emit({Opcode::store, 1, value, *to.index, place(to.field + i)});
        else
            emitter_.emit({Opcode::move, 1, place(to.operand + i), value});
    }

    Target target(const Expression& expression) {
        const std::uint32_t count = expression.type == Type::entry ? setting_.floats() : 1;
        switch (expression.meaning) {
        case Meaning::variable:
            return {variable(expression.slot), {}, 0, 1};
        case Meaning::fragment:
            return {operand(Bank::locals, expression.slot), {}, 0, count};
        case Meaning::of_state:
            return {operand(Bank::pixel, setting_.k * setting_.floats() + expression.slot), {}, 0, 1};
        case Meaning::of_entry:
            return entry(expression, count);
        default:
            break;
        }
        CHECK(false);
    }

    Target entry(const Expression& expression, std::uint32_t count) {
        const Value index = evaluate(expression.operands.front(), {});
        if (!index.constant) return {0, index.operand, expression.slot, count};
        if (!(index.number >= 0.0F && index.number < static_cast<float>(setting_.k)))
            complain(setting_.program.source, expression.place,
                     fmt::format("an index from 0 to {} (k is {})", setting_.k - 1, setting_.k),
                     fmt::format("{}", index.number));
        const auto number = static_cast<std::uint32_t>(index.number);
        return {operand(Bank::pixel, number * setting_.floats() + expression.slot), {}, 0, count};
    }

    void evaluate_into(const Expression& expression, Operand to) {
        const Value value = evaluate(expression, to);
        if (value.constant || value.operand != to) emitter_.emit({Opcode::move, 1, to, emitter_.read(value)});
    }

    /// A result that has to be computed goes to `into`, or to a temporary.
    Value evaluate(const Expression& expression, std::optional<Operand> into) {
        switch (expression.kind) {
        case Expression::Kind::literal:
            return known(static_cast<float>(expression.value));
        case Expression::Kind::operation:
            return operation(expression, into);
        case Expression::Kind::reference:
            break;
        }
        switch (expression.meaning) {
        case Meaning::constant:
            return known(setting_.constants[expression.slot]);
        case Meaning::entries:
            return known(static_cast<float>(setting_.k));
        case Meaning::largest:
            return known(std::numeric_limits<float>::max());
        case Meaning::counter:
            return known(counters_[expression.slot]);
        default:
            return {false, 0.0F, get(target(expression), 0, into)};
        }
    }

    static Value known(float number) { return {true, number, 0}; }

    Value operation(const Expression& expression, std::optional<Operand> into) {
        const std::vector<Expression>& operands = expression.operands;
        if (is_product_added(expression)) return multiply_add(expression, into);
        std::array<Value, 3> values;
        for (std::size_t i = 0; i < operands.size(); ++i) values[i] = evaluate(operands[i], {});
        if (expression.constant)
            return known(
                fold(expression.operation, expression.type, {values[0].number, values[1].number, values[2].number}));
        Instruction instruction{opcode(expression)};
        instruction.b = emitter_.read(values[0]);
        if (operands.size() > 1) instruction.c = emitter_.read(values[1]);
        if (operands.size() > 2) instruction.d = emitter_.read(values[2]);
        const bool turned =
            expression.operation == Operation::greater || expression.operation == Operation::greater_or_equal;
        if (turned) std::swap(instruction.b, instruction.c);
        instruction.a = into ? *into : emitter_.temporary();
        emitter_.emit(instruction);
        const bool sums = expression.operation == Operation::add || expression.operation == Operation::subtract ||
                          expression.operation == Operation::multiply;
        if (sums && expression.type == Type::integer)
            emitter_.emit({Opcode::truncate, 0, instruction.a, instruction.a});
        return {false, 0.0F, instruction.a};
    }

    static bool is_product_added(const Expression& expression) {
        if (expression.operation != Operation::add || expression.type != Type::number) return false;
        const Expression& product = expression.operands[1];
        return product.kind == Expression::Kind::operation && product.operation == Operation::multiply &&
               product.type == Type::number && !product.constant;
    }

    Value multiply_add(const Expression& expression, std::optional<Operand> into) {
        const std::vector<Expression>& factors = expression.operands[1].operands;
        Instruction instruction{Opcode::multiply_add};
        instruction.b = emitter_.read(evaluate(expression.operands[0], {}));
        instruction.c = emitter_.read(evaluate(factors[0], {}));
        instruction.d = emitter_.read(evaluate(factors[1], {}));
        instruction.a = into ? *into : emitter_.temporary();
        emitter_.emit_product(instruction);
        return {false, 0.0F, instruction.a};
    }

    static Opcode opcode(const Expression& expression) {
        switch (expression.operation) {
        case Operation::negate:
            return Opcode::negate;
        case Operation::invert:
            return Opcode::invert;
        case Operation::add:
            return Opcode::add;
        case Operation::subtract:
            return Opcode::subtract;
        case Operation::multiply:
            return Opcode::multiply;
        case Operation::divide:
            return expression.type == Type::integer ? Opcode::divide_whole : Opcode::divide;
        case Operation::less:
        case Operation::greater:
            return Opcode::less;
        case Operation::less_or_equal:
        case Operation::greater_or_equal:
            return Opcode::less_or_equal;
        case Operation::equal:
            return Opcode::equal;
        case Operation::not_equal:
            return Opcode::not_equal;
        case Operation::both:
        case Operation::least:
            return Opcode::least;
        case Operation::either:
        case Operation::greatest:
            return Opcode::greatest;
        case Operation::magnitude:
            return Opcode::magnitude;
        case Operation::truncate:
            return Opcode::truncate;
        case Operation::choose:
            return Opcode::choose;
        }
        CHECK(false);
    }

    const Setting& setting_;
    Emitter emitter_;
    std::vector<float> counters_;
    std::uint32_t rounds_ = 0;
};

std::vector<float> constants_of(const Setting& so_far, const Overrides& overrides) {
    Setting setting = so_far;
    for (const Definition& constant : setting.program.constants) {
        const auto chosen = overrides.find(constant.name);
        const bool number = constant.value.type == Type::number;
        setting.constants.push_back(chosen != overrides.end() && number
                                        ? finite(chosen->second)
                                        : Generator(setting, 0).constant(constant.value));
    }
    return setting.constants;
}

Code entry_code(const Setting& setting) {
    Generator generator(setting, static_cast<std::uint32_t>(std::size(shader_fields)));
    for (std::uint32_t i = 0; i < setting.floats(); ++i)
        generator.store(setting.program.entry[i].value, operand(Bank::pixel, i));
    return generator.take();
}

Code block_code(const Setting& setting, const std::vector<Statement>& block) {
    Generator generator(setting, setting.floats() + setting.program.variables);
    generator.block(block);
    return generator.take();
}

std::vector<float> clear_of(const Setting& setting) {
    const Program& program = setting.program;
    const std::uint32_t entries = setting.k * setting.floats();
    std::vector<float> pixel((entries + program.state.size() + 3) / 4 * 4, 0.0F);
    Generator generator(setting, 0);
    for (const Definition& field : program.empty) {
        const auto named = [&](const Definition& one) { return one.name == field.name; };
        const auto slot = std::find_if(program.entry.begin(), program.entry.end(), named) - program.entry.begin();
        for (std::uint32_t i = 0; i < setting.k; ++i)
            pixel[std::size_t{i} * setting.floats() + static_cast<std::size_t>(slot)] = generator.constant(field.value);
    }
    for (std::size_t i = 0; i < program.state.size(); ++i)
        pixel[entries + i] = generator.constant(program.state[i].value);
    return pixel;
}

} // namespace

CompiledProgram compile(const Program& program, std::uint32_t k, const Overrides& overrides) {
    Setting setting{program, k, {}};
    setting.constants = constants_of(setting, overrides);
    return {entry_code(setting), block_code(setting, program.fragment), block_code(setting, program.drain),
            clear_of(setting)};
}

} // namespace models::language
