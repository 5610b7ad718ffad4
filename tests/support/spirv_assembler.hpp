// SPIR-V modules by hand, for tests: one shader whose main function is written instruction by instruction.
#pragma once

#include "traces/spirv/opcodes.hpp"
#include "traces/spirv/quad.hpp"
#include "traces/spirv/std450.hpp"

#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

namespace tests {

class SpirvAssembler {
  public:
    using Id = std::uint32_t;
    using Op = traces::spirv::Op;
    using Storage = traces::spirv::Storage;
    using Words = std::vector<std::uint32_t>;

    enum class Stage : std::uint32_t { vertex = 0, fragment = 4 };
    explicit SpirvAssembler(Stage stage = Stage::fragment);

    Id id() { return next_++; }

    Id nothing() { return type(Op::type_void, {}); }
    Id truth() { return type(Op::type_bool, {}); }
    Id real() { return type(Op::type_float, {32}); }
    Id whole() { return type(Op::type_int, {32, 1}); }
    Id natural() { return type(Op::type_int, {32, 0}); }
    Id vector(Id component, std::uint32_t n) { return n == 1 ? component : type(Op::type_vector, {component, n}); }
    Id matrix(std::uint32_t columns, std::uint32_t rows) {
        return type(Op::type_matrix, {vector(real(), rows), columns});
    }
    Id array(Id element, std::uint32_t n) { return type(Op::type_array, {element, constant(n)}); }
    Id pointer(Storage storage, Id to) { return type(Op::type_pointer, {static_cast<std::uint32_t>(storage), to}); }
    /// Each call makes a type of its own, so that it can be decorated.
    Id structure(const Words& members) { return declare(Op::type_struct, 0, members); }
    Id array_with_stride(Id element, std::uint32_t n, std::uint32_t bytes);
    Id sampled_image(std::uint32_t dimension, bool depth = false, bool arrayed = false, Id texel = 0);

    Id constant(float value);
    Id constant(std::int32_t value) { return number(whole(), static_cast<std::uint32_t>(value)); }
    Id constant(std::uint32_t value) { return number(natural(), value); }
    Id constant(bool value) { return type(value ? Op::constant_true : Op::constant_false, {truth()}, true); }
    Id composite(Id of, const Words& parts);

    Id input(Id of, std::uint32_t location);
    Id output(Id of, std::uint32_t location);
    Id uniform(Id of, const std::string& name); ///< plain; the storage class of textures, too
    Id block(Id structure, const std::string& name);
    Id built_in(Storage storage, Id of, std::uint32_t number);
    Id local(Id of, Id initial = 0); ///< of the function that is being written
    Id global(Storage storage, Id of, Id initial = 0);

    void decorate(Id id, std::uint32_t decoration, const Words& operands = {});
    void decorate_member(Id id, std::uint32_t member, std::uint32_t decoration, const Words& operands = {});
    void name(Id id, const std::string& text);
    void name_member(Id id, std::uint32_t member, const std::string& text);

    Id result(Op op, Id of, const Words& operands); ///< an instruction with a result of this type
    void write(Op op, const Words& operands);       ///< one without
    Id extended(traces::spirv::Std450 function, Id of, const Words& operands);
    void label(Id block) { put(*body_, Op::label, {block}); }
    Id load(Id variable, Id of) { return result(Op::load, of, {variable}); }
    void store(Id variable, Id value) { write(Op::store, {variable, value}); }

    /// A function other than main, from its first block to end_function(); returns ids of its parameters.
    std::vector<Id> begin_function(Id function, Id returns, const Words& parameters);
    void end_function();

    Id main() const { return main_; }
    /// The module; main returns at its end unless it ended by itself.
    Words module(bool returns = true) const;
    /// The same as a vertex shader.
    Words vertex_module() const;

  private:
    Id type(Op op, const Words& operands, bool typed = false);
    Id declare(Op op, Id of, const Words& operands);
    Id number(Id of, std::uint32_t bits);
    Id variable(Storage storage, Id of, Id initial = 0);
    static void put(Words& to, Op op, const Words& operands);
    static void add_text(Words& to, const std::string& text);

    Stage stage_;
    Id next_ = 1;
    Id std450_, main_, entry_;
    Words annotations_, declarations_, locals_, main_body_, functions_, function_locals_;
    Words interface_;
    Words* body_ = &main_body_;
    Words pending_; ///< body of the function that is being written
    std::map<Words, Id> known_;
};

/// Textures whose value says what was asked for: the last calls are kept.
class RecordedTextures : public traces::spirv::ShaderTextures {
  public:
    traces::spirv::Texels sample(const traces::spirv::TextureSample& call) override;
    traces::spirv::Texels fetch(const traces::spirv::TextureFetch& call) override;
    traces::spirv::TextureSize size(std::uint32_t texture, std::uint32_t element, std::int32_t level) override;
    std::int32_t levels(std::uint32_t, std::uint32_t) override { return 7; }
    std::int32_t samples(std::uint32_t, std::uint32_t) override { return 4; }
    traces::spirv::Texels level(const traces::spirv::TextureSample& call) override;

    std::vector<traces::spirv::TextureSample> sampled;
    std::vector<traces::spirv::TextureFetch> fetched;
    std::vector<traces::spirv::TextureSample> levels_asked;
};

/// A module with its program and a quad, without uniforms; throws what these throw.
struct SpirvRun {
    explicit SpirvRun(const SpirvAssembler::Words& words, std::uint64_t budget = traces::spirv::usual_budget)
        : module(words), program(module), quad(program, budget), uniforms(program.uniform_words) {
        quad.set_uniforms(uniforms);
    }
    void run(unsigned covered = 15) {
        quad.set_uniforms(uniforms);
        quad.run(textures, covered);
    }
    const traces::spirv::InterfaceVariable& input(std::uint32_t location) const;
    const traces::spirv::InterfaceVariable& output(std::uint32_t location) const;
    pipeline::Lanes real(std::uint32_t location = 0, std::uint32_t i = 0) const {
        return quad.get(output(location), i);
    }
    traces::spirv::LaneWords words(std::uint32_t location = 0, std::uint32_t i = 0) const {
        return quad.get_words(output(location), i);
    }

    traces::spirv::Module module;
    traces::spirv::Program program;
    traces::spirv::Quad quad;
    std::vector<std::uint32_t> uniforms;
    RecordedTextures textures;
};

} // namespace tests
