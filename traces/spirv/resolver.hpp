// Makes a Program of a Module; private to resolve*.cpp.
#pragma once

#include "traces/spirv/layout.hpp"
#include "traces/spirv/operations.hpp"
#include "traces/spirv/texture_call.hpp"

#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace traces::spirv {

class Resolver {
  public:
    Resolver(const Module& module, Program& program) : module_(module), program_(program), values_(module.bound()) {}
    void resolve();

  private:
    enum class Is : std::uint8_t { nothing, registers, pointer, texture };
    struct Value {
        Is is = Is::nothing;
        Id type = 0;
        Slot slot = 0;           ///< of registers
        std::uint32_t index = 0; ///< of pointers and textures
    };
    struct Index { ///< that varies
        Slot slot = 0;
        std::uint32_t stride = 0, bound = 0;
    };
    struct Pointer {
        Storage storage{};
        bool uniform = false;     ///< into words of uniforms; else into registers
        bool constant = false;    ///< registers that nothing writes
        std::int64_t base = 0;    ///< slot or word
        std::uint32_t stride = 1; ///< of the components of the vector that it points to
        Layout layout{};
        std::optional<std::uint32_t> texture{};
        std::vector<Index> indices{};
    };
    struct PendingEdge {
        std::uint32_t edge = 0;
        Id from = 0, to = 0;
        Instruction user;
    };
    struct Phi {
        Instruction instruction;
        Id block = 0;
        Slot slot = 0;
    };
    struct Construct {
        Id merge = 0;
        bool loop = false;
    };
    /// A function whose body is being put in place.
    struct Activation {
        const Function* function = nullptr;
        Activation* caller = nullptr;
        std::map<Id, std::uint32_t> blocks{};
        std::vector<PendingEdge> edges{};
        std::vector<Phi> phis{};
        std::vector<Construct> constructs{};
        std::vector<std::uint32_t> returns{}; ///< edges
        bool in_loop = false;
        Id label = 0; ///< of the block that is being resolved
        Slot result = 0;
    };

    // resolve.cpp: functions and blocks
    void function(const Function& function, Activation& activation);
    void call(const Instruction& instruction);
    void begin_block();
    void end_block(Ending ending, Slot condition, std::uint32_t first_edge);
    void ending(const Instruction& instruction);
    void choice(const Instruction& instruction);
    void kill(const Instruction& instruction);
    void leave(const Instruction& instruction);
    void edge_to(const Instruction& instruction, Id label);
    void initialise(const Instruction& user, Slot slot, Id constant);
    void finish_edges(Activation& activation);
    void make_moves(const Activation& activation, const PendingEdge& pending, Edge& edge);
    void phi(const Instruction& instruction);
    void instruction(const Instruction& instruction);

    // resolve_interface.cpp
    void variables();
    void interface_variable(const Variable& variable, bool input);
    InterfaceVariable described(const Type& type, std::string name, const Decorations& decorations, Slot slot) const;
    void uniform_variable(const Variable& variable);
    void texture_variable(const Variable& variable);

    // resolve_memory.cpp
    bool memory(const Instruction& instruction);
    void local_variable(const Instruction& instruction);
    void access_chain(const Instruction& instruction);
    void step(const Instruction& instruction, Pointer& pointer, Id& type, std::uint32_t operand);
    void advance(Pointer& pointer, const Instruction& instruction, std::uint32_t operand, std::uint32_t count,
                 std::uint32_t stride);
    Value load(const Instruction& instruction, const Pointer& pointer, Id type);
    Value load_uniform(const Instruction& instruction, const Pointer& pointer, Id type);
    void store(const Instruction& instruction, const Pointer& pointer, Slot from, std::uint32_t count);
    std::uint32_t list_of(const Pointer& pointer);
    const Pointer& pointer(const Instruction& instruction, std::uint32_t i, Id* type = nullptr) const;

    // resolve_values.cpp
    bool composite(const Instruction& instruction);
    void shuffle(const Instruction& instruction);
    void construct(const Instruction& instruction);
    void extract(const Instruction& instruction);
    void insert(const Instruction& instruction);
    std::pair<Id, std::uint32_t> part(const Instruction& instruction, Id type, std::uint32_t first) const;
    void select(const Instruction& instruction);
    void vector_component(const Instruction& instruction);
    void gather(std::span<const Slot> from, Slot to);

    // resolve_arithmetic.cpp
    bool arithmetic(const Instruction& instruction);
    bool component_wise(const Instruction& instruction, std::span<const ComponentWise> table, std::uint32_t number,
                        std::uint32_t first);
    bool bit_field(const Instruction& instruction);
    bool linear(const Instruction& instruction);
    void product(const Instruction& instruction);
    void pair(const Instruction& instruction, Handler handler, std::string_view kinds, std::uint32_t first);

    // resolve_std450.cpp
    void extended(const Instruction& instruction);
    bool geometric(const Instruction& instruction, Std450 function);
    bool splits(const Instruction& instruction, Std450 function);
    bool packs(const Instruction& instruction, Std450 function);
    bool interpolates(const Instruction& instruction, Std450 function);

    // resolve_textures.cpp
    bool texture(const Instruction& instruction);
    void sampled_image(const Instruction& instruction);
    void image_of(const Instruction& instruction);
    void sample(const Instruction& instruction);
    void fetch(const Instruction& instruction);
    void query(const Instruction& instruction);
    void image_operands(const Instruction& instruction, std::uint32_t at, TextureCall& call, std::uint32_t coordinates);
    const TextureReference& reference(const Instruction& instruction, std::uint32_t i) const;
    void add_call(const Instruction& instruction, const TextureCall& call, Handler handler);

    // Values and registers.
    /// Resolving ends after so much work, whatever a module asks for.
    void spend(const Instruction& user, std::uint64_t work);
    Slot allocate(const Instruction& user, std::uint32_t count);
    Slot allocate_fixed(const Instruction& user, std::uint32_t count);
    Slot fixed(const Instruction& user, std::span<const std::uint32_t> scalars);
    Value constant(Id id, const Instruction& user);
    /// Of an operand: registers, pointers or textures that were defined.
    Value value(const Instruction& instruction, std::uint32_t i);
    Value registers(const Instruction& instruction, std::uint32_t i);
    /// A scalar or vector of this kind (as in ComponentWise::signature) and number of components.
    Slot lanes(const Instruction& instruction, std::uint32_t i, char kind, std::uint32_t components);
    void check_kind(const Instruction& instruction, Id type, char kind, std::uint32_t components,
                    std::string_view what) const;
    const Type& type(Id id) const { return module_.type(id); }
    Kind scalar_kind(const Type& type) const;
    /// Of a scalar or vector; throws for others.
    std::uint32_t components(const Instruction& instruction, Id type) const;
    Slot define(const Instruction& instruction); ///< registers for its result
    void define_as(const Instruction& instruction, Value value);
    void emit(const Instruction& user, Operation operation);
    std::uint32_t operand(const Instruction& instruction, std::uint32_t i) const {
        return module_.operand(instruction, i);
    }
    void require(bool good, const Instruction& instruction, std::string_view problem) const {
        if (!good) fail(instruction, problem);
    }

    const Module& module_;
    Program& program_;
    std::vector<Value> values_; ///< by id
    std::vector<Pointer> pointers_;
    std::vector<TextureReference> references_;
    std::map<Id, Slot> constants_;
    std::map<std::pair<Id, std::vector<std::uint32_t>>, Slot> uniform_registers_; ///< by type and words
    Activation* activation_ = nullptr;
    Block block_;
    std::vector<Operation> block_operations_;
    std::uint32_t slots_ = 0;
    std::uint64_t spent_ = 0;
};

} // namespace traces::spirv
