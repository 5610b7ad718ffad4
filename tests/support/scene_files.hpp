// Small glTF files made by tests, one property at a time.
#pragma once

#include "traces/scene.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace support {

/// A folder that is removed with its files at the end.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::filesystem::path write(const std::string& name, std::string_view bytes) const;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// A glTF document under construction: one buffer, kept in the file as a data URI or beside the JSON in a .glb.
class GltfFile {
  public:
    GltfFile();

    nlohmann::json json; ///< everything but the buffer; change it at will

    /// Appends data as a bufferView of its own and returns the number of an accessor on it.
    int add(const std::vector<float>& values, const std::string& type);
    template <class T>
    int add_integers(const std::vector<T>& values, const std::string& type, int component_type,
                     bool normalized = false) {
        return add_accessor({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)}, type,
                            component_type, normalized);
    }
    int add_view(std::string_view bytes);

    std::string text() const;   ///< a .gltf file
    std::string binary() const; ///< a .glb file

    /// The scene after writing text() to a file and reading it back.
    traces::Scene load() const;
    /// The message of the sim::InputError that load() throws, without the file's path; "" when it does not.
    std::string error() const;

  private:
    int add_accessor(std::string_view bytes, const std::string& type, int component_type, bool normalized);
    nlohmann::json with_buffer(bool data_uri) const;

    std::string buffer_;
};

/// One triangle (0,0,0) (1,0,0) (0,1,0) in mesh 0, node 0, scene 0; its position accessor is number 0.
GltfFile triangle_file();

/// The message of the sim::InputError for a file or specification, with `folder` taken out; "" when it loads.
std::string load_error(const std::string& spec, const std::filesystem::path& folder = {});

/// Position i of a geometry of the scene.
glm::vec3 position_at(const traces::Scene& scene, std::uint32_t geometry, std::uint32_t i);

} // namespace support
