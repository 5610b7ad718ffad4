// Primitives of glTF meshes as geometries.
#pragma once

#include "pipeline/draw.hpp"
#include "traces/gltf/accessors.hpp"
#include "traces/gltf/document.hpp"
#include "traces/gltf/nodes.hpp"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace traces::gltf {

/// True for lists, strips and fans of triangles.
bool makes_triangles(const tinygltf::Primitive& primitive);

/// Triangles of every primitive of the file, each counted once, drawn or not.
std::uint64_t count_triangles(const Document& document, const Accessors& accessors);

class Geometries {
  public:
    Geometries(const Document& document, Accessors& accessors, const Hierarchy& hierarchy,
               pipeline::Resources& resources)
        : document_(document), accessors_(accessors), hierarchy_(hierarchy), resources_(resources) {}

    /// The number among the resources of a primitive of a node's mesh. Draws share it, except those of skins and of
    /// nodes with morph weights of their own.
    std::uint32_t use(std::size_t node, std::size_t primitive);

    /// Leads a geometry with a skin into the world. It mirrors where the joints do, so that faces keep their front
    /// (glTF 2.0, section 3.7.4), of which the vertices alone know nothing.
    glm::mat4 skin_to_world(std::uint32_t geometry) const;

    /// Of which it was read otherwise than it is written.
    void add_notes(std::vector<std::string>& notes) const;

  private:
    // A primitive at its node, for as long as it is read.
    struct Source {
        const tinygltf::Primitive& primitive;
        const tinygltf::Node& node;
        const tinygltf::Mesh& mesh;
        std::string place;
    };
    pipeline::Geometry read(const Source& source);
    void read_indices(pipeline::Geometry& geometry, const Source& source);
    void read_shape(pipeline::Geometry& geometry, const Source& source, const std::vector<double>& weights);
    void read_attribute(pipeline::Geometry& geometry, const Source& source, const char* name,
                        pipeline::Semantic semantic, std::array<std::uint8_t, 2> components);
    void morph(std::vector<glm::vec4>& values, const Source& source, const std::vector<double>& weights,
               const char* name);
    std::vector<glm::mat4> skin_matrices(const Source& source, std::size_t vertices);
    pipeline::VertexAttribute packed(const std::string& name, pipeline::Semantic semantic,
                                     const std::vector<glm::vec4>& values);

    const Document& document_;
    Accessors& accessors_;
    const Hierarchy& hierarchy_;
    pipeline::Resources& resources_;
    std::map<std::array<std::size_t, 3>, std::uint32_t> geometries_; ///< by mesh, primitive, node (or none)
    std::set<std::uint32_t> mirrored_;                               ///< geometries whose joints mirror them
    std::size_t raw_colours_ = 0; ///< primitives with colours of integers that are not normalized
    std::size_t computed_ = 0;    ///< vertices of geometries that are not in the file
};

} // namespace traces::gltf
