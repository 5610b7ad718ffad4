// A binary glTF file under construction: its JSON, and the one buffer beside it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace traces::gltf {

class GlbFile {
  public:
    GlbFile();

    nlohmann::ordered_json json; ///< everything but `buffers`
    std::vector<std::string> notes;

    /// Appends to a list of the document and returns the number of the new element.
    std::size_t add(const char* list, nlohmann::ordered_json element);
    /// A bufferView of its own, at a multiple of 4 bytes. `stride` and `target`: 0 = not stated.
    std::size_t add_view(std::span<const std::byte> bytes, std::uint32_t stride = 0, std::uint32_t target = 0);
    void use_extension(const char* name, bool required);

    /// Throws sim::InputError naming `path`.
    void write(const std::filesystem::path& path) const;

  private:
    std::vector<std::byte> buffer_;
};

constexpr std::uint32_t vertex_target = 34962, index_target = 34963;

} // namespace traces::gltf
