// Accessors of a glTF file: checked, then either used where they lie or decoded.
#pragma once

#include "pipeline/draw.hpp"
#include "traces/gltf/document.hpp"

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace traces::gltf {

/// What an accessor must be to serve for something.
struct Wanted {
    std::uint8_t least_components = 1, most_components = 4;
    bool matrix = false;     ///< 4x4 instead of components
    bool normalized = false; ///< integers are, whether the accessor says so or not

    std::string components_text() const {
        return least_components == most_components ? fmt::format("{}", least_components)
                                                   : fmt::format("{} to {}", least_components, most_components);
    }
};

class Accessors {
  public:
    /// Buffers that draws need are appended to `buffers`.
    Accessors(const Document& document, std::vector<pipeline::Buffer>& buffers)
        : document_(document), buffers_(buffers) {}

    const tinygltf::Accessor& get(int index, std::string_view place) const {
        return document_.at(document_.model().accessors, index, place, "accessor");
    }

    /// True when the elements lie in one bufferView as they are to be read.
    bool lies_in_file(int index, std::string_view place) const;

    /// The attribute of an accessor that lies in the file; its bufferView becomes a buffer.
    pipeline::VertexAttribute in_place(int index, pipeline::Semantic semantic, const Wanted& wanted,
                                       std::string_view place);

    /// All elements as floats, normalised where the accessor says so, sparse ones put in their places. Missing
    /// components are 0, the fourth 1.
    std::vector<glm::vec4> floats(int index, const Wanted& wanted, std::string_view place) const;
    std::vector<glm::mat4> matrices(int index, std::string_view place) const;

    /// Where the indices of a geometry lie, as an attribute with one component. Sparse ones get a buffer of their own,
    /// of 32-bit indices.
    pipeline::VertexAttribute indices_in_place(int index, std::string_view place);

    /// A buffer that is not in the file.
    template <class T>
    std::uint32_t add_buffer(std::string name, std::span<const T> values) {
        const auto bytes = std::as_bytes(values);
        buffers_.push_back({std::move(name), {bytes.begin(), bytes.end()}, 0});
        return static_cast<std::uint32_t>(buffers_.size() - 1);
    }

  private:
    // Elements in a bufferView, all of them checked to be there; `attribute.buffer` is the bufferView.
    struct Elements {
        pipeline::VertexAttribute attribute;
        std::size_t count = 0;
    };
    Elements elements(int index, const Wanted& wanted, std::string_view place) const;
    void require_inside(const Elements& elements, std::size_t bytes_each, std::string_view place) const;
    void overlay(std::vector<glm::vec4>& values, const tinygltf::Accessor& accessor, const Elements& base,
                 std::string_view place) const;
    std::vector<glm::vec4> read(const Elements& elements, std::string_view place) const;
    pipeline::VertexAttribute computed_indices(int index, std::string_view place);
    std::uint32_t buffer_of_view(std::uint32_t view, std::string_view place);

    const Document& document_;
    std::vector<pipeline::Buffer>& buffers_;
    std::map<std::uint32_t, std::uint32_t> buffer_of_view_;
};

} // namespace traces::gltf
