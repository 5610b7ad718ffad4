// Appends instructions and keeps their limits.
#pragma once

#include "models/programs/language/code.hpp"
#include "models/programs/language/lexer.hpp"

namespace models::language {

/// A float that is known, or the place where it lies.
struct Value {
    bool constant = false;
    float number = 0.0F;
    Operand operand = 0;
};

class Emitter {
  public:
    /// @param first_temporary  local from which on temporaries may lie
    Emitter(const Source& source, std::uint32_t first_temporary)
        : source_(source), first_temporary_(first_temporary), next_temporary_(first_temporary) {}

    void begin_statement(Place place) {
        place_ = place;
        next_temporary_ = first_temporary_;
    }

    void emit(Instruction instruction);
    /// A jump to be aimed later.
    std::size_t emit_jump(Instruction instruction);
    /// Aims it at what comes next.
    void aim(std::size_t jump);

    /// Joins a jump over the swap behind it, if these are the last two instructions, to one conditional swap. Returns
    /// whether it did.
    bool join_swap(std::size_t jump);

    /// Lets a multiply_add continue the one before it, as those of the channels of a colour do.
    void emit_product(Instruction instruction);

    Operand temporary();
    /// Where a value can be read.
    Operand read(const Value& value);

    Code take();

  private:
    Operand placed(Operand operand) const;
    Operand pooled(float number);

    const Source& source_;
    std::uint32_t first_temporary_, next_temporary_;
    Place place_;
    std::size_t last_aim_ = 0; ///< what comes before it is not continued behind it
    Code code_;
};

} // namespace models::language
