// Programs as SPIR-V, and where their inputs come from.
#pragma once

#include "traces/record_module/stream.hpp"
#include "traces/recording/fixed_function.hpp"
#include "traces/recording/import/gl_state.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace traces::recorded {

struct ImportedProgram {
    std::uint32_t number = 0;                       ///< of Recording::programs
    std::string problem;                            ///< why it cannot be compiled; "": it was
    std::map<std::uint32_t, std::string> variables; ///< by slot of the attribute
    bool flat = false;                              ///< may have flat inputs of fragments
    bool numbers = false;                           ///< asks for the number of a vertex
};

class ProgramImport {
  public:
    explicit ProgramImport(Recording& recording) : recording_(recording) {}

    /// Compiled at the first time.
    const ImportedProgram& program_of(const record_stream::Program& program, std::int32_t number);
    /// The same for equal texts. Throws sim::InputError.
    std::uint32_t number_of(const FixedFunctionProgram& program);

  private:
    Recording& recording_;
    std::map<std::int32_t, ImportedProgram> known_;
    std::map<std::pair<std::string, std::string>, std::uint32_t> fixed_function_;
};

/// pipeline::Semantic of the fog coordinate: of generated shaders, and of those of the application.
std::uint32_t fog_of_fixed_function();
std::uint32_t fog_of_programs();

} // namespace traces::recorded
