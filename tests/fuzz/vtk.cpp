// The reader of legacy VTK files, and the scene made of what it read.
#include "tests/fuzz/expect_input_error.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "traces/tetrahedra/vtk_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const fuzz::MemoryFile file(bytes, size);
    fuzz::expect_result_or_input_error([&] { traces::scene_of(traces::read_vtk(traces::InputBytes(file.path()))); });
    return 0;
}
