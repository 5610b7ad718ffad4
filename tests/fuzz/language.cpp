// Texts of programs in the k-buffer language. What compiles is run.
#include "models/programs/language/user_program.hpp"
#include "tests/fuzz/expect_input_error.hpp"
#include "tests/fuzz/run_program.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(bytes), size);
    fuzz::expect_result_or_input_error([&] { fuzz::run_program(*models::user_program("fuzz.kb", text, 0).program); });
    return 0;
}
