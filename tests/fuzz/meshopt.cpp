// meshopt-compressed attributes and triangles in a .glb file; the first two bytes choose mode and filter.
#include "tests/fuzz/binary_file.hpp"
#include "tests/fuzz/expect_input_error.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "traces/gltf_import.hpp"

#include <array>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    if (size < 3) return 0;
    constexpr std::array<const char*, 3> modes{"ATTRIBUTES", "TRIANGLES", "INDICES"};
    constexpr std::array<const char*, 4> filters{"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
    const bool indices = bytes[0] % modes.size() != 0;
    const std::string glb = fuzz::binary_file(
        fmt::format(R"({{"asset": {{"version": "2.0"}}, "nodes": [{{"mesh": 0}}], "buffers": [{{"byteLength": SIZE}}],
            "bufferViews": [{{"buffer": 0, "byteLength": {0}, "extensions": {{"EXT_meshopt_compression":
                {{"buffer": 0, "byteLength": SIZE, "byteStride": {1}, "count": {2}, "mode": "{3}", "filter": "{4}"}}}}}}],
            "accessors": [{{"componentType": 5126, "count": 3, "type": "VEC3"{5}}},
                          {{"bufferView": 0, "componentType": 5125, "count": 3, "type": "SCALAR"}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}{6}}}]}}]}})",
                    indices ? 12 : 48, indices ? 4 : 16, 3, modes[bytes[0] % modes.size()],
                    filters[bytes[1] % filters.size()], indices ? "" : R"(, "bufferView": 0)",
                    indices ? R"(, "indices": 1)" : ""),
        bytes + 2, size - 2);
    const fuzz::MemoryFile file(reinterpret_cast<const std::uint8_t*>(glb.data()), glb.size());
    fuzz::expect_result_or_input_error([&] { traces::import_gltf(file.path()); });
    return 0;
}
