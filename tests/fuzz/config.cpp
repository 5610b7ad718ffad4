// The configuration of a run: a TOML file; behind a zero byte, one --set per line.
#include "sim/config.hpp"
#include "models/kbuffers/library.hpp"
#include "pipeline/gpu_params.hpp"
#include "tests/fuzz/expect_input_error.hpp"

#include <cstddef>
#include <cstdint>

namespace {

void set_lines(sim::Config& config, std::string_view lines) {
    while (!lines.empty()) {
        const std::size_t end = lines.find('\n');
        config.set(lines.substr(0, end));
        lines = end == std::string_view::npos ? std::string_view() : lines.substr(end + 1);
    }
}

void read(std::string_view text) {
    const std::size_t zero = text.find('\0');
    sim::Config config = sim::Config::from_toml_text(text.substr(0, zero), "gpu.toml");
    if (zero != std::string_view::npos) set_lines(config, text.substr(zero + 1));
    pipeline::GpuParams gpu;
    config.read("", gpu);
    models::check_design_sections(config);
    config.expect_all_used();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    fuzz::expect_result_or_input_error([&] { read({reinterpret_cast<const char*>(bytes), size}); });
    return 0;
}
