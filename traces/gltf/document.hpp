// A glTF file as tinygltf reads it, after everything that can be checked before the data is looked at.
#pragma once

#include <filesystem>
#include <fmt/format.h>
#include <span>
#include <string>
#include <string_view>
#include <tiny_gltf.h>
#include <utility>
#include <vector>

namespace traces::gltf {

/// Images are kept as they lie in the file (undecoded); those in a bufferView are not copied at all.
class Document {
  public:
    /// Throws sim::InputError for a file that cannot be read, is cut off, is not glTF 2.0, or requires an extension
    /// that is not read.
    explicit Document(const std::filesystem::path& path);

    const tinygltf::Model& model() const { return model_; }
    const std::string& name() const { return name_; }
    const std::string& hash() const { return hash_; } ///< over the file and all files it names

    /// What of the file is not read; import adds to it.
    std::vector<std::string> notes;

    [[noreturn]] void fail(std::string_view place, std::string_view expected) const;

    template <class... Arguments>
    void require(bool good, std::string_view place, fmt::format_string<Arguments...> expected,
                 Arguments&&... arguments) const {
        if (!good) fail(place, fmt::format(expected, std::forward<Arguments>(arguments)...));
    }

    /// The element of `list` that a property names; throws when there is none.
    template <class T>
    const T& at(const std::vector<T>& list, int index, std::string_view place, std::string_view what) const {
        require(index >= 0 && static_cast<std::size_t>(index) < list.size(), place,
                "the number of one of {} {}s, got {}", list.size(), what, index);
        return list[static_cast<std::size_t>(index)];
    }

    /// The bytes of a bufferView, checked to lie in its buffer.
    std::span<const unsigned char> view_bytes(int view, std::string_view place) const;

  private:
    std::string name_;
    std::string hash_;
    tinygltf::Model model_;
};

/// "mesh 3 \"wheel\"", or without the name when there is none.
std::string place_of(std::string_view kind, std::size_t index, const std::string& name);

} // namespace traces::gltf
