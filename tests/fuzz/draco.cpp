// Draco meshes in a .glb file; the library itself runs in a child process, so that its crashes are refusals.
#include "tests/fuzz/binary_file.hpp"
#include "tests/fuzz/expect_input_error.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "traces/gltf_import.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    if (size == 0) return 0;
    const std::string glb = fuzz::binary_file(
        R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "buffers": [{"byteLength": SIZE}],
            "bufferViews": [{"buffer": 0, "byteLength": SIZE}],
            "accessors": [{"componentType": 5126, "count": 4, "type": "VEC3"},
                          {"componentType": 5123, "count": 6, "type": "SCALAR"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "extensions":
                {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}}]}]})",
        bytes, size);
    const fuzz::MemoryFile file(reinterpret_cast<const std::uint8_t*>(glb.data()), glb.size());
    fuzz::expect_result_or_input_error([&] { traces::import_gltf(file.path()); });
    return 0;
}
