// Programs in GLSL as draw traces have them: a text, and a last line with its modules. What resolves is run.
#include "tests/fuzz/expect_input_error.hpp"
#include "tests/fuzz/run_program.hpp"
#include "traces/user_programs.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const std::string program = "fuzz.glsl\n" + std::string(reinterpret_cast<const char*>(bytes), size);
    fuzz::expect_result_or_input_error([&] {
        fuzz::run_program(*traces::chosen_program(program, {"", 0, 0.5F}).program);
    });
    return 0;
}
