#include "models/programs/language/interpreter.hpp"

#include "models/programs/language/arithmetic.hpp"

#include <bit>

namespace models::language {

namespace {

std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

/// Returns the bits that differed.
template <std::uint32_t count>
std::uint32_t exchange_floats(float* a, float* b) {
    std::array<float, count> of_a, of_b;
    std::copy_n(a, count, of_a.begin());
    std::copy_n(b, count, of_b.begin());
    std::copy_n(of_b.begin(), count, a);
    std::copy_n(of_a.begin(), count, b);
    std::uint32_t different = 0;
    for (std::uint32_t i = 0; i < count; ++i) different |= bits(of_a[i]) ^ bits(of_b[i]);
    return different;
}

/// All bits where a place lies in the pixel, else none.
std::uint32_t pixel_mask(std::uint32_t place) { return place / own_floats - 1U; }

} // namespace

Run::Run(const Code& code) : code_(code) {
    std::fill_n(own_.begin(), code.locals, 0.0F);
    float* constant = own_.data() + code.locals;
    for (const float value : code.constants) *constant++ = value;
}

bool Run::execute(float* pixel) {
    float* const banks[2] = {pixel, own_.data()};
    std::uint32_t changed = 0; // bits of the pixel that differed
    const auto address = [&banks](std::uint32_t place) { return banks[place / own_floats] + place % own_floats; };
    const auto read = [&address](std::uint32_t place) { return *address(place); };
    const auto write = [&](std::uint32_t place, float value) {
        float* const to = address(place);
        changed |= (bits(*to) ^ bits(value)) & pixel_mask(place);
        *to = value;
    };
    const auto exchange = [&](std::uint32_t a, std::uint32_t b, std::uint32_t count) {
        float *const first = address(a), *const second = address(b);
        std::uint32_t different = 0;
        if (count == 4) // a render target, as an entry is most often
            different = exchange_floats<4>(first, second);
        else
            for (std::uint32_t i = 0; i < count; ++i) different |= exchange_floats<1>(first + i, second + i);
        changed |= different & (pixel_mask(a) | pixel_mask(b));
    };
    // An index that is computed is cut to the entries there are.
    const auto entry_field = [&](const Instruction& now) {
        const float last = static_cast<float>(code_.entries - 1);
        const auto entry = static_cast<std::uint32_t>(std::clamp(read(now.b), 0.0F, last));
        return entry * code_.floats_per_entry + now.c;
    };
    const Instruction* const first = code_.instructions.data();
    for (const Instruction* at = first;;) {
        const Instruction& now = *at++;
        switch (now.code) {
        case Opcode::end:
            return changed != 0;
        case Opcode::move:
            for (std::uint32_t i = 0; i < now.count; ++i) write(now.a + i, read(now.b + i));
            break;
        case Opcode::swap:
            exchange(now.a, now.b, now.count);
            break;
        case Opcode::swap_if_less:
            if (read(now.b) < read(now.c)) exchange(now.a, now.d, now.count);
            break;
        case Opcode::swap_if_less_or_equal:
            if (read(now.b) <= read(now.c)) exchange(now.a, now.d, now.count);
            break;
        case Opcode::load:
            write(now.a, read(entry_field(now)));
            break;
        case Opcode::store:
            write(entry_field(now), read(now.a));
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

} // namespace models::language
