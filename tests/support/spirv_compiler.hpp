// A fragment shader as SPIR-V, not optimised and optimised. For oracles; where the module that compiles was not built,
// `problem` says so.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tests {

struct CompiledSpirv {
    std::vector<std::uint32_t> plain, optimised; ///< the latter by spirv-opt -O
    std::string problem;                         ///< of the compiler; "" when there is none
};

CompiledSpirv compile_fragment_shader(const std::string& source);

} // namespace tests
