// SPIR-V modules. What resolves is run, within a budget.
#include "tests/fuzz/expect_input_error.hpp"
#include "traces/spirv/quad.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace {

class NoTexels : public traces::spirv::ShaderTextures {
  public:
    traces::spirv::Texels sample(const traces::spirv::TextureSample&) override { return {}; }
    traces::spirv::Texels fetch(const traces::spirv::TextureFetch&) override { return {}; }
    traces::spirv::TextureSize size(std::uint32_t, std::uint32_t, std::int32_t) override { return {}; }
    std::int32_t levels(std::uint32_t, std::uint32_t) override { return 1; }
    std::int32_t samples(std::uint32_t, std::uint32_t) override { return 1; }
    traces::spirv::Texels level(const traces::spirv::TextureSample&) override { return {}; }
};

void run(const std::vector<std::uint32_t>& words) {
    constexpr std::uint64_t budget = 10'000;
    const traces::spirv::Module module(words);
    const traces::spirv::Program program(module);
    traces::spirv::Quad quad(program, budget);
    const std::vector<std::uint32_t> uniforms(program.uniform_words, 3);
    quad.set_uniforms(uniforms);
    for (const auto& input : program.inputs)
        for (std::uint32_t i = 0; i < input.components * input.columns * input.elements; ++i)
            quad.set(input, i, {0.5F, 3.0F, -1.0F, 1e9F});
    NoTexels textures;
    quad.run(textures);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    std::vector<std::uint32_t> words(size / 4);
    if (!words.empty()) std::memcpy(words.data(), bytes, words.size() * 4);
    fuzz::expect_result_or_input_error([&] { run(words); });
    return 0;
}
