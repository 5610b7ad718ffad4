#include "traces/gltf/geometry.hpp"

#include "sim/counted.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>
#include <limits>

namespace traces::gltf {

using pipeline::Geometry;
using pipeline::Semantic;
using pipeline::Topology;
using pipeline::VertexAttribute;

namespace {

constexpr std::size_t no_node = std::numeric_limits<std::size_t>::max();
constexpr std::size_t most_computed = 1U << 27U; ///< vertices; a small file can ask for any number of skinned copies

const glm::mat4 mirror(glm::vec4(-1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0), glm::vec4(0, 0, 0, 1));

const std::vector<double>& weights_of(const tinygltf::Node& node, const tinygltf::Mesh& mesh) {
    return node.weights.empty() ? mesh.weights : node.weights;
}

bool is_morphed(const std::vector<double>& weights) {
    return std::any_of(weights.begin(), weights.end(), [](double weight) { return weight != 0.0; });
}

bool has(const tinygltf::Primitive& primitive, const char* attribute) {
    return primitive.attributes.contains(attribute);
}

std::uint64_t triangles_of(const tinygltf::Primitive& primitive, std::uint64_t count) {
    if (primitive.mode == TINYGLTF_MODE_TRIANGLES) return count / 3;
    return count < 3 ? 0 : count - 2;
}

Topology topology_of(int mode) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) return Topology::triangle_strip;
    return mode == TINYGLTF_MODE_TRIANGLE_FAN ? Topology::triangle_fan : Topology::triangles;
}

} // namespace

bool makes_triangles(const tinygltf::Primitive& primitive) {
    return primitive.mode == TINYGLTF_MODE_TRIANGLES || primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
           primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

std::uint64_t count_triangles(const Document& document, const Accessors& accessors) {
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < document.model().meshes.size(); ++i) {
        const tinygltf::Mesh& mesh = document.model().meshes[i];
        const std::string place = place_of("mesh", i, mesh.name);
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
            if (!makes_triangles(primitive) || !has(primitive, "POSITION")) continue;
            const int accessor = primitive.indices >= 0 ? primitive.indices : primitive.attributes.at("POSITION");
            total += triangles_of(primitive, accessors.get(accessor, place).count);
        }
    }
    return total;
}

std::uint32_t Geometries::use(std::size_t node_index, std::size_t primitive_index) {
    const auto& model = document_.model();
    const tinygltf::Node& node = model.nodes[node_index];
    const auto mesh = static_cast<std::size_t>(node.mesh);
    const auto& all = model.meshes[mesh].primitives;
    const Source source{
        all[primitive_index], node, model.meshes[mesh],
        fmt::format("{} primitive {}", place_of("mesh", mesh, model.meshes[mesh].name), primitive_index)};
    const bool shared = node.skin < 0 && node.weights.empty();
    const auto [entry, is_new] =
        geometries_.try_emplace({mesh, primitive_index, shared ? no_node : node_index}, static_cast<std::uint32_t>(0));
    if (is_new) {
        Geometry geometry = read(source);
        entry->second = static_cast<std::uint32_t>(resources_.geometries.size());
        resources_.geometries.push_back(std::move(geometry));
    }
    return entry->second;
}

glm::mat4 Geometries::skin_to_world(std::uint32_t geometry) const {
    return mirrored_.contains(geometry) ? mirror : glm::mat4(1.0F);
}

void Geometries::add_notes(std::vector<std::string>& notes) const {
    if (raw_colours_ > 0)
        notes.push_back(fmt::format("COLOR_0 of integers that are not normalized ({}), which glTF does not "
                                    "know: they are read as if they were",
                                    sim::counted(raw_colours_, "primitive")));
}

Geometry Geometries::read(const Source& source) {
    const auto& attributes = source.primitive.attributes;
    const std::size_t count = accessors_.get(attributes.at("POSITION"), source.place + " POSITION").count;
    document_.require(count <= std::numeric_limits<std::uint32_t>::max(), source.place, "fewer than 2^32 vertices");
    Geometry geometry;
    geometry.name = source.place;
    geometry.topology = topology_of(source.primitive.mode);
    geometry.vertex_count = static_cast<std::uint32_t>(count);
    geometry.index_count = geometry.vertex_count;

    const std::vector<double>& weights = weights_of(source.node, source.mesh);
    const std::size_t targets = source.primitive.targets.size();
    document_.require(targets == 0 || weights.empty() || weights.size() == targets, source.place,
                      "weights for its {} targets, got {}", targets, weights.size());
    if (source.node.skin >= 0 || is_morphed(weights)) {
        read_shape(geometry, source, weights);
    } else {
        read_attribute(geometry, source, "POSITION", Semantic::position, {3, 3});
        read_attribute(geometry, source, "NORMAL", Semantic::normal, {3, 3});
    }
    read_attribute(geometry, source, "COLOR_0", Semantic::colour, {3, 4});
    read_attribute(geometry, source, "TEXCOORD_0", Semantic::texcoord0, {2, 2});
    read_attribute(geometry, source, "TEXCOORD_1", Semantic::texcoord1, {2, 2});
    if (source.primitive.indices >= 0) read_indices(geometry, source);
    return geometry;
}

void Geometries::read_indices(Geometry& geometry, const Source& source) {
    const std::string place = source.place + " indices";
    const VertexAttribute found = accessors_.indices_in_place(source.primitive.indices, place);
    const tinygltf::Accessor& data = accessors_.get(source.primitive.indices, place);
    document_.require(data.count <= std::numeric_limits<std::uint32_t>::max(), place, "fewer than 2^32 indices");
    geometry.index_type = found.type == pipeline::ComponentType::u8    ? pipeline::IndexType::u8
                          : found.type == pipeline::ComponentType::u16 ? pipeline::IndexType::u16
                                                                       : pipeline::IndexType::u32;
    geometry.index_buffer = found.buffer;
    geometry.index_offset = found.offset;
    geometry.index_count = static_cast<std::uint32_t>(data.count);
}

void Geometries::read_attribute(Geometry& geometry, const Source& source, const char* name, Semantic semantic,
                                std::array<std::uint8_t, 2> components) {
    if (!has(source.primitive, name)) return;
    const int accessor = source.primitive.attributes.at(name);
    const std::string place = fmt::format("{} {}", source.place, name);
    const bool colours = semantic == Semantic::colour;
    const Wanted wanted{.least_components = components[0], .most_components = components[1], .normalized = colours};
    const tinygltf::Accessor& data = accessors_.get(accessor, place);
    if (colours && data.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT && !data.normalized) ++raw_colours_;
    document_.require(data.count == geometry.vertex_count, place, "a count of {} like POSITION, got {}",
                      geometry.vertex_count, data.count);
    if (accessors_.lies_in_file(accessor, place)) {
        geometry.attributes.push_back(accessors_.in_place(accessor, semantic, wanted, place));
        return;
    }
    VertexAttribute attribute = packed(place, semantic, accessors_.floats(accessor, wanted, place));
    geometry.attributes.push_back(attribute);
}

// Positions are three floats, colours four; texture coordinates get by with their first two.
VertexAttribute Geometries::packed(const std::string& name, Semantic semantic, const std::vector<glm::vec4>& values) {
    computed_ += values.size();
    document_.require(computed_ <= most_computed, name, "at most {} vertices of sparse, morphed and skinned meshes",
                      most_computed);
    const bool pairs = slot_of(semantic) == pipeline::Slot::texcoord;
    const std::uint32_t components = semantic == Semantic::colour ? 4 : pairs ? 2 : 3;
    std::vector<float> floats;
    floats.reserve(values.size() * components);
    for (const glm::vec4& value : values)
        for (std::uint32_t i = 0; i < components; ++i) floats.push_back(value[static_cast<int>(i)]);
    VertexAttribute attribute;
    attribute.semantic = semantic;
    attribute.components = static_cast<std::uint8_t>(components);
    attribute.stride = components * 4;
    attribute.buffer = accessors_.add_buffer<float>(name, floats);
    return attribute;
}

void Geometries::morph(std::vector<glm::vec4>& values, const Source& source, const std::vector<double>& weights,
                       const char* name) {
    for (std::size_t i = 0; i < source.primitive.targets.size() && i < weights.size(); ++i) {
        const auto found = source.primitive.targets[i].find(name);
        if (weights[i] == 0.0 || found == source.primitive.targets[i].end()) continue;
        const std::string place = fmt::format("{} target {} {}", source.place, i, name);
        const auto moves = accessors_.floats(found->second, {3, 3}, place);
        document_.require(moves.size() == values.size(), place, "a count of {} like {}, got {}", values.size(), name,
                          moves.size());
        for (std::size_t v = 0; v < values.size(); ++v)
            values[v] += static_cast<float>(weights[i]) * glm::vec4(glm::vec3(moves[v]), 0.0F);
    }
}

// One matrix per vertex: the joints' matrices of the rest pose, weighted (glTF 2.0, section 3.7.3.3). They lead to
// world space, whatever the transform of the skinned node.
std::vector<glm::mat4> Geometries::skin_matrices(const Source& source, std::size_t vertices) {
    const auto& skin = document_.at(document_.model().skins, source.node.skin, source.place, "skin");
    std::vector<glm::mat4> inverse_bind(skin.joints.size(), glm::mat4(1.0F));
    if (skin.inverseBindMatrices >= 0)
        inverse_bind = accessors_.matrices(skin.inverseBindMatrices, source.place + " inverseBindMatrices");
    document_.require(inverse_bind.size() >= skin.joints.size(), source.place,
                      "inverseBindMatrices with a count of {}, as many as joints, got {}", skin.joints.size(),
                      inverse_bind.size());
    std::vector<glm::dmat4> joints;
    for (std::size_t i = 0; i < skin.joints.size(); ++i)
        joints.push_back(document_.at(hierarchy_.world, skin.joints[i], source.place + " skin", "joint") *
                         glm::dmat4(inverse_bind[i]));

    std::vector<glm::dmat4> sums(vertices, glm::dmat4(0.0));
    std::vector<double> totals(vertices, 0.0);
    for (int set = 0; has(source.primitive, fmt::format("JOINTS_{}", set).c_str()); ++set) {
        const std::string place = fmt::format("{} JOINTS_{}", source.place, set);
        const std::string name = fmt::format("WEIGHTS_{}", set);
        document_.require(has(source.primitive, name.c_str()), place, "{} as well", name);
        const int joint_accessor = source.primitive.attributes.at(fmt::format("JOINTS_{}", set));
        document_.require(!accessors_.get(joint_accessor, place).normalized, place, "integers that are not normalized");
        const auto numbers = accessors_.floats(joint_accessor, {4, 4}, place);
        const auto weights = accessors_.floats(source.primitive.attributes.at(name), {4, 4}, place);
        document_.require(numbers.size() == vertices && weights.size() == vertices, place,
                          "a count of {} like POSITION, got {} and {} {}", vertices, numbers.size(), weights.size(),
                          name);
        for (std::size_t v = 0; v < vertices; ++v)
            for (int i = 0; i < 4; ++i) {
                const double weight = static_cast<double>(weights[v][i]);
                if (!(weight > 0.0)) continue;
                sums[v] += document_.at(joints, static_cast<int>(numbers[v][i]), place, "joint") * weight;
                totals[v] += weight;
            }
    }
    std::vector<glm::mat4> matrices(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
        document_.require(totals[v] > 0.0, source.place, "joints with a positive weight at vertex {}", v);
        matrices[v] = glm::mat4(sums[v] / totals[v]);
    }
    return matrices;
}

void Geometries::read_shape(Geometry& geometry, const Source& source, const std::vector<double>& weights) {
    const auto& attributes = source.primitive.attributes;
    auto positions = accessors_.floats(attributes.at("POSITION"), {3, 3}, source.place + " POSITION");
    morph(positions, source, weights, "POSITION");
    std::vector<glm::vec4> normals;
    if (has(source.primitive, "NORMAL")) {
        normals = accessors_.floats(attributes.at("NORMAL"), {3, 3}, source.place + " NORMAL");
        document_.require(normals.size() == positions.size(), source.place + " NORMAL",
                          "a count of {} like POSITION, got {}", positions.size(), normals.size());
        morph(normals, source, weights, "NORMAL");
    }
    if (source.node.skin >= 0) {
        auto matrices = skin_matrices(source, positions.size());
        const auto mirroring = std::count_if(matrices.begin(), matrices.end(), [](const glm::mat4& matrix) {
            return glm::determinant(glm::dmat3(glm::dmat4(matrix))) < 0.0;
        });
        if (2 * static_cast<std::size_t>(mirroring) > matrices.size()) {
            mirrored_.insert(
                static_cast<std::uint32_t>(resources_.geometries.size())); // the number it is going to have
            for (glm::mat4& matrix : matrices) matrix = mirror * matrix;
        }
        for (std::size_t v = 0; v < positions.size(); ++v)
            positions[v] = matrices[v] * glm::vec4(glm::vec3(positions[v]), 1.0F);
        for (std::size_t v = 0; v < normals.size(); ++v)
            if (glm::determinant(glm::mat3(matrices[v])) != 0.0F)
                normals[v] = glm::vec4(glm::inverseTranspose(glm::mat3(matrices[v])) * glm::vec3(normals[v]), 0.0F);
    }
    geometry.attributes.push_back(packed(source.place + " POSITION", Semantic::position, positions));
    if (normals.empty()) return;
    for (glm::vec4& normal : normals) {
        const float length = glm::length(glm::vec3(normal));
        if (length > 0.0F) normal /= length;
    }
    geometry.attributes.push_back(packed(source.place + " NORMAL", Semantic::normal, normals));
}

} // namespace traces::gltf
