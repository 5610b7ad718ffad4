// The table of glTF's properties: a document that passes it passes it again, unchanged.
#include "tests/fuzz/expect_input_error.hpp"
#include "traces/gltf/json_check.hpp"

#include <cstdint>
#include <nlohmann/json.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(bytes), size);
    fuzz::expect_result_or_input_error([&] {
        std::vector<std::string> notes;
        const auto once = traces::gltf::checked_json("fuzz", text, notes);
        const auto twice = traces::gltf::checked_json("fuzz", once.dump(), notes);
        CHECK(once == twice);
    });
    return 0;
}
