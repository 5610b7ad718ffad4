// The reader of .gltf and .glb files.
#include "tests/fuzz/expect_input_error.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "traces/gltf_import.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const fuzz::MemoryFile file(bytes, size);
    fuzz::expect_result_or_input_error([&] { traces::import_gltf(file.path()).resources->read_textures(); });
    return 0;
}
