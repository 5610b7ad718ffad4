#include "models/programs/language/interpreter.hpp"

#include "models/programs/language/arithmetic.hpp"

#include <bit>

namespace models::language {

namespace {

class Machine {
  public:
    Machine(const Code& code, float* pixel, float* locals)
        : code_(code), writable_{pixel, locals}, readable_{pixel, locals, code.constants.data()} {}

    bool run() {
        const Instruction* const first = code_.instructions.data();
        for (const Instruction* at = first;;) {
            const Instruction& now = *at++;
            switch (now.code) {
            case Opcode::end:
                return changed_[0] != 0;
            case Opcode::move:
                for (std::uint32_t i = 0; i < now.count; ++i) write(now.a + i, read(now.b + i));
                break;
            case Opcode::swap:
                for (std::uint32_t i = 0; i < now.count; ++i) exchange(now.a + i, now.b + i);
                break;
            case Opcode::load:
                write(now.a, *entry_field(now));
                break;
            case Opcode::store:
                put(entry_field(now), 0, read(now.a));
                break;
            case Opcode::negate:
                write(now.a, -read(now.b));
                break;
            case Opcode::invert:
                write(now.a, 1.0F - read(now.b));
                break;
            case Opcode::magnitude:
                write(now.a, std::abs(read(now.b)));
                break;
            case Opcode::truncate:
                write(now.a, truncated(read(now.b)));
                break;
            case Opcode::add:
                write(now.a, finite(read(now.b) + read(now.c)));
                break;
            case Opcode::subtract:
                write(now.a, finite(read(now.b) - read(now.c)));
                break;
            case Opcode::multiply:
                write(now.a, finite(read(now.b) * read(now.c)));
                break;
            case Opcode::divide:
                write(now.a, quotient(read(now.b), read(now.c)));
                break;
            case Opcode::divide_whole:
                write(now.a, whole_quotient(read(now.b), read(now.c)));
                break;
            case Opcode::least:
                write(now.a, std::min(read(now.b), read(now.c)));
                break;
            case Opcode::greatest:
                write(now.a, std::max(read(now.b), read(now.c)));
                break;
            case Opcode::multiply_add:
                write(now.a, finite(read(now.b) + finite(read(now.c) * read(now.d))));
                break;
            case Opcode::less:
                write(now.a, read(now.b) < read(now.c) ? 1.0F : 0.0F);
                break;
            case Opcode::less_or_equal:
                write(now.a, read(now.b) <= read(now.c) ? 1.0F : 0.0F);
                break;
            case Opcode::equal:
                write(now.a, read(now.b) == read(now.c) ? 1.0F : 0.0F);
                break;
            case Opcode::not_equal:
                write(now.a, read(now.b) != read(now.c) ? 1.0F : 0.0F);
                break;
            case Opcode::choose:
                write(now.a, read(now.b) != 0.0F ? read(now.c) : read(now.d));
                break;
            case Opcode::jump:
                at = first + now.d;
                break;
            case Opcode::jump_if_false:
                if (read(now.b) == 0.0F) at = first + now.d;
                break;
            case Opcode::unless_less:
                if (!(read(now.b) < read(now.c))) at = first + now.d;
                break;
            case Opcode::unless_less_or_equal:
                if (!(read(now.b) <= read(now.c))) at = first + now.d;
                break;
            case Opcode::unless_equal:
                if (!(read(now.b) == read(now.c))) at = first + now.d;
                break;
            case Opcode::unless_not_equal:
                if (!(read(now.b) != read(now.c))) at = first + now.d;
                break;
            }
        }
    }

  private:
    float read(std::uint32_t from) const { return readable_[from >> bank_shift][from % bank_size]; }

    void write(std::uint32_t to, float value) {
        const std::uint32_t bank = to >> bank_shift;
        put(writable_[bank] + to % bank_size, bank, value);
    }

    void put(float* to, std::uint32_t bank, float value) {
        changed_[bank] |= std::bit_cast<std::uint32_t>(*to) ^ std::bit_cast<std::uint32_t>(value);
        *to = value;
    }

    void exchange(std::uint32_t a, std::uint32_t b) {
        const float kept = read(a);
        write(a, read(b));
        write(b, kept);
    }

    // An index that is computed is cut to the entries there are.
    float* entry_field(const Instruction& now) const {
        const float last = static_cast<float>(code_.entries - 1);
        const auto entry = static_cast<std::uint32_t>(std::clamp(read(now.b), 0.0F, last));
        return writable_[0] + entry * code_.floats_per_entry + now.c;
    }

    const Code& code_;
    float* writable_[2];
    const float* readable_[3];
    std::uint32_t changed_[2] = {0, 0}; ///< bits that differed, of each bank
};

} // namespace

bool run(const Code& code, float* pixel, float* locals) { return Machine(code, pixel, locals).run(); }

} // namespace models::language
