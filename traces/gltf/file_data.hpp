// The bytes beside the JSON of a glTF file: containers, files and data URIs.
#pragma once

#include "traces/hash.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace traces::gltf {

using Bytes = std::vector<unsigned char>;

inline constexpr std::uint64_t largest_file = std::uint64_t{1} << 31U; ///< bytes

/// A regular file of at most 2 GiB, or nothing.
std::optional<Bytes> read_file(const std::filesystem::path& path);

/// The two parts of a file; they lie in its bytes.
struct Parts {
    std::string_view json;
    std::optional<std::span<const unsigned char>> binary; ///< the chunk beside it, of a container
};

/// The parts of a .glb container (glTF 2.0, section 4.4) or of a .gltf file, told apart by their first bytes. Throws
/// sim::InputError for a length that leads out of the file.
Parts parts_of(const std::string& name, const Bytes& bytes);

/// What the URIs of one document name, read once each and added to a hash.
class FileData {
  public:
    /// @param path of the document, beside which its files lie
    FileData(const std::filesystem::path& path, ContentHash& hash) : folder_(path.parent_path()), hash_(hash) {}

    /// Nothing when there is no such file, or no such data in the URI.
    std::optional<Bytes> at(const std::string& uri);

  private:
    std::filesystem::path folder_;
    ContentHash& hash_;
};

/// A URI for a message: cut off, as data can be long.
std::string short_uri(const std::string& uri);

} // namespace traces::gltf
