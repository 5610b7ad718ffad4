// Runs a program for a quad, four vertices or any four invocations. One for each thread; the program is shared.
//
// All four lanes run, so that differences within the quad exist; lanes that discard go on as helpers where they can
// meet the others again. Divergence: lanes wait until those that stand at earlier blocks have caught up. Every run
// starts from the same registers: the result depends on inputs, uniforms and textures only.
#pragma once

#include "pipeline/functional/lanes.hpp"
#include "traces/spirv/program.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace traces::spirv {

/// Instructions and moved registers of a run; at 20 ns each, 0.1 s.
inline constexpr std::uint64_t usual_budget = 1ULL << 22;

class Quad {
  public:
    /// `program` outlives it. A run that needs more than the budget throws sim::InputError.
    explicit Quad(const Program& program, std::uint64_t budget = usual_budget);

    /// Program::uniform_words words, which outlive it.
    void set_uniforms(std::span<const std::uint32_t> uniforms);

    /// Scalar i of a variable at the border; see InterfaceVariable::slot.
    void set(const InterfaceVariable& input, std::uint32_t i, const pipeline::Lanes& lanes);
    void set_words(const InterfaceVariable& input, std::uint32_t i, const LaneWords& lanes); ///< truths: 0 or all ones
    pipeline::Lanes get(const InterfaceVariable& output, std::uint32_t i) const;
    LaneWords get_words(const InterfaceVariable& output, std::uint32_t i) const;

    /// `covered`: lanes that are no helpers, as gl_HelperInvocation says.
    void run(ShaderTextures& textures, unsigned covered = 15);

    unsigned alive() const { return alive_; } ///< lanes that were not discarded
    /// SPIR-V instructions that each lane executed until it was discarded.
    const LaneWords& instructions() const { return instructions_; }
    std::uint32_t longest(unsigned lanes = 15) const;

  private:
    static constexpr std::uint32_t finished = 0xFFFFFFFF;

    void execute(Run& run, std::uint32_t first, std::uint32_t count);
    void execute_masked(Run& run, std::uint32_t first, std::uint32_t count);
    void go(Run& run, const Edge& edge, unsigned lanes);
    void leave(Run& run, const Block& block);
    void choose(Run& run, const Block& block);
    bool schedule(Run& run);

    const Program& program_;
    std::uint64_t budget_;
    std::vector<Words> registers_, kept_; ///< kept: what a masked operation overwrites
    Words* file_;                         ///< slot 0
    std::span<const std::uint32_t> uniforms_;
    const InterfaceVariable* helper_;
    std::array<std::uint32_t, 4> at_{}; ///< block that a lane runs next
    std::uint32_t block_ = 0;
    unsigned alive_ = 15;
    LaneWords instructions_{};
};

} // namespace traces::spirv
