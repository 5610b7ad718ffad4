// Texts of programs in the k-buffer language. What compiles is run, and must leave finite floats.
#include "models/programs/language/user_program.hpp"
#include "tests/fuzz/expect_input_error.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace {

void run(const pipeline::ModifyProgram& program) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::vector<float> pixel(program.floats_per_pixel());
    program.clear(pixel.data());
    std::array<float, pipeline::largest_entry> entry{};
    const std::array<float, 4> rgba{0.5F, std::numeric_limits<float>::quiet_NaN(), infinity, -1e-40F};
    for (const float depth : {0.5F, 0.25F, 0.0F, 1.0F, -infinity}) {
        program.make_entry({rgba.data(), depth, 3}, entry.data());
        program.insert(pixel.data(), entry.data());
    }
    program.drain(pixel.data());
    for (const float value : pixel) CHECK(std::isfinite(value));
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(bytes), size);
    fuzz::expect_result_or_input_error([&] { run(*models::user_program("fuzz.kb", text, 0).program); });
    return 0;
}
