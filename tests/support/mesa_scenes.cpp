#include "tests/support/mesa_scenes.hpp"

#include "pipeline/functional/front_end.hpp"
#include "sim/random.hpp"
#include "tests/support/paths.hpp"

#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>
#include <stdexcept>

namespace tests {

namespace {

/// Model coordinates are pixels (y down) and window depth; for powers of two as sizes every step is exact.
glm::mat4 window_matrix(std::uint32_t width, std::uint32_t height) {
    glm::mat4 matrix(1.0F);
    matrix[0][0] = 2.0F / static_cast<float>(width);
    matrix[1][1] = -2.0F / static_cast<float>(height);
    matrix[2][2] = 2.0F;
    matrix[3] = glm::vec4(-1.0F, 1.0F, -1.0F, 1.0F);
    return matrix;
}

void add_triangle(TriangleScene& scene, const std::array<glm::dvec3, 3>& corners) {
    for (const glm::dvec3& corner : corners) {
        scene.indices.push_back(static_cast<std::uint32_t>(scene.positions.size()));
        scene.positions.emplace_back(corner);
    }
}

void add_sphere(TriangleScene& scene, const glm::dvec3& centre, std::uint32_t rings, std::uint32_t segments) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (std::uint32_t ring = 0; ring <= rings; ++ring) {
        const double polar = std::numbers::pi * ring / rings;
        for (std::uint32_t segment = 0; segment <= segments; ++segment) {
            const double turn = 2.0 * std::numbers::pi * segment / segments;
            const glm::dvec3 direction(std::sin(polar) * std::cos(turn), std::cos(polar),
                                       std::sin(polar) * std::sin(turn));
            scene.positions.emplace_back(centre + 0.45 * direction);
        }
    }
    const std::uint32_t row = segments + 1;
    for (std::uint32_t ring = 0; ring < rings; ++ring)
        for (std::uint32_t segment = 0; segment < segments; ++segment) {
            const std::uint32_t corner = first + ring * row + segment;
            for (const std::uint32_t offset : {0U, 1U, row, row, 1U, row + 1}) scene.indices.push_back(corner + offset);
        }
}

/// Looks at a box from the front and a little above, so that it fills most of the picture.
glm::mat4 camera_for(const glm::vec3& low, const glm::vec3& high, std::uint32_t width, std::uint32_t height) {
    const glm::vec3 centre = (low + high) * 0.5F;
    const float radius = glm::length(high - low) * 0.5F;
    const glm::vec3 eye = centre + radius * glm::vec3(0.6F, 0.7F, 2.2F);
    const glm::mat4 view = glm::lookAt(eye, centre, glm::vec3(0.0F, 1.0F, 0.0F));
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    return glm::perspective(glm::radians(48.0F), aspect, radius * 0.5F, radius * 8.0F) * view;
}

std::vector<char> read_bytes(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(fmt::format("cannot read {}", path.string()));
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// As much of glTF as the meshes of the comparison need: float positions and integer indices of one primitive.
class PositionReader {
  public:
    explicit PositionReader(const std::filesystem::path& path) {
        const std::vector<char> bytes = read_bytes(path);
        if (path.extension() == ".glb") {
            std::uint32_t json_size = 0;
            std::memcpy(&json_size, bytes.data() + 12, 4);
            json_ = nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + json_size);
            binary_.assign(bytes.begin() + 28 + json_size, bytes.end());
        } else {
            json_ = nlohmann::json::parse(bytes);
            binary_ = read_bytes(path.parent_path() / json_["buffers"][0]["uri"].get<std::string>());
        }
    }

    void read(TriangleScene& scene) const {
        const auto& primitive = json_["meshes"][0]["primitives"][0];
        const auto& positions = json_["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
        scene.positions.resize(positions["count"]);
        for (std::size_t i = 0; i < scene.positions.size(); ++i)
            std::memcpy(&scene.positions[i], element(positions, i, 12), 12);
        const auto& indices = json_["accessors"][primitive["indices"].get<std::size_t>()];
        const std::size_t size = indices["componentType"] == 5125 ? 4 : indices["componentType"] == 5123 ? 2 : 1;
        scene.indices.resize(indices["count"]);
        for (std::size_t i = 0; i < scene.indices.size(); ++i)
            std::memcpy(&scene.indices[i], element(indices, i, size), size); // little-endian, as the file
    }

  private:
    const char* element(const nlohmann::json& accessor, std::size_t i, std::size_t size) const {
        const auto& view = json_["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        const std::size_t stride = view.value("byteStride", size);
        return binary_.data() + view.value("byteOffset", std::size_t{0}) +
               accessor.value("byteOffset", std::size_t{0}) + i * stride;
    }

    nlohmann::json json_;
    std::vector<char> binary_;
};

template <class Element>
pipeline::Buffer buffer_with(const std::vector<Element>& elements) {
    pipeline::Buffer buffer;
    const auto bytes = std::as_bytes(std::span(elements));
    buffer.bytes.assign(bytes.begin(), bytes.end());
    return buffer;
}

} // namespace

TriangleScene random_soup(std::uint32_t triangles, double size, std::uint64_t seed, std::uint32_t grid) {
    TriangleScene scene;
    scene.name = grid == 0 ? fmt::format("{} triangles of {} pixels", triangles, size)
                           : fmt::format("{} triangles of {} pixels on a grid of 1/{} pixel", triangles, size, grid);
    scene.matrix = window_matrix(scene.width, scene.height);
    sim::Random random(seed, "random soup");
    const auto place = [&](double range) { return size + random.uniform() * (range - 2.0 * size); };
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const glm::dvec3 centre(place(scene.width), place(scene.height), 0.1 + 0.8 * random.uniform());
        std::array<glm::dvec3, 3> corners;
        for (glm::dvec3& corner : corners) {
            const glm::dvec3 offset(random.uniform() - 0.5, random.uniform() - 0.5, 0.1 * (random.uniform() - 0.5));
            corner = centre + offset * glm::dvec3(2.0 * size, 2.0 * size, 1.0);
            if (grid == 0) continue;
            for (int axis = 0; axis < 2; ++axis) corner[axis] = std::round(corner[axis] * grid) / grid;
        }
        add_triangle(scene, corners);
    }
    return scene;
}

TriangleScene clipped_soup(std::uint32_t triangles, double size, std::uint64_t seed) {
    TriangleScene scene;
    scene.name = fmt::format("{} triangles of {} pixels across the view volume's planes", triangles, size);
    scene.matrix = window_matrix(scene.width, scene.height);
    sim::Random random(seed, "clipped soup");
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const glm::dvec3 centre(random.uniform() * scene.width, random.uniform() * scene.height, random.uniform());
        std::array<glm::dvec3, 3> corners;
        for (glm::dvec3& corner : corners) {
            const glm::dvec3 offset(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
            corner = centre + offset * glm::dvec3(2.0 * size, 2.0 * size, 1.0);
        }
        add_triangle(scene, corners);
    }
    return scene;
}

TriangleScene sphere_grid(std::uint32_t spheres_in_row, std::uint32_t rings, std::uint32_t segments) {
    TriangleScene scene;
    const std::uint32_t n = spheres_in_row;
    scene.name = fmt::format("{} spheres of {} triangles", n * n * n, 2 * rings * segments);
    for (std::uint32_t i = 0; i < n * n * n; ++i)
        add_sphere(scene, glm::dvec3(i % n, (i / n) % n, i / (n * n)), rings, segments);
    const auto last = static_cast<float>(n) - 0.5F;
    scene.matrix = camera_for(glm::vec3(-0.5F), glm::vec3(last), scene.width, scene.height);
    return scene;
}

std::optional<TriangleScene> mesh_scene(const std::filesystem::path& relative) {
    const auto path = ropsim_test::shared_file(relative);
    if (!path) return std::nullopt;
    TriangleScene scene;
    scene.name = relative.stem().string();
    PositionReader(*path).read(scene);
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const glm::vec3& position : scene.positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    scene.matrix = camera_for(low, high, scene.width, scene.height);
    return scene;
}

PipelineScene pipeline_scene(const TriangleScene& scene, bool double_sided) {
    PipelineScene result;
    result.resources.buffers = {buffer_with(scene.positions), buffer_with(scene.indices)};
    pipeline::Geometry geometry;
    geometry.topology = scene.topology;
    geometry.attributes = {pipeline::VertexAttribute{}};
    geometry.vertex_count = static_cast<std::uint32_t>(scene.positions.size());
    geometry.index_type = pipeline::IndexType::u32;
    geometry.index_buffer = 1;
    geometry.index_count = static_cast<std::uint32_t>(scene.indices.size());
    result.resources.geometries = {geometry};
    pipeline::Material material;
    material.double_sided = double_sided;
    result.resources.materials = {material};
    result.draws = {pipeline::Draw{scene.name, 0, 0, {glm::mat4(1.0F)}}};
    result.view.projection = scene.matrix;
    result.view.width = scene.width;
    result.view.height = scene.height;
    return result;
}

std::uint32_t primitive_of(const pipeline::FragmentStream& stream, const pipeline::Quad& quad) {
    return stream.triangles[quad.triangle].primitive;
}

void for_each_fragment(const pipeline::FragmentStream& stream,
                       const std::function<void(std::size_t pixel, std::size_t quad, std::size_t lane)>& visit) {
    for (std::size_t i = 0; i < stream.quads.size(); ++i) {
        const pipeline::Quad& quad = stream.quads[i];
        for (std::size_t lane = 0; lane < 4; ++lane)
            if (((quad.covered >> lane) & 1U) != 0)
                visit((quad.y + lane / 2) * std::size_t{stream.width} + quad.x + lane % 2, i, lane);
    }
}

pipeline::FragmentStream rasterize_scene(const TriangleScene& scene, bool double_sided) {
    const PipelineScene own = pipeline_scene(scene, double_sided);
    own.resources.validate(scene.name);
    pipeline::FrontEndOptions options;
    options.colours = false;
    options.states = {&scene.state, 1};
    options.depth_step = 0.0; // the depth buffer of the renderer holds floats
    return pipeline::rasterize(own.resources, own.draws, std::vector<std::uint32_t>{0}, own.view, options);
}

OwnPicture count_fragments(const pipeline::FragmentStream& stream) {
    OwnPicture picture;
    picture.count.resize(std::size_t{stream.width} * stream.height);
    picture.id.resize(picture.count.size());
    picture.depth.assign(picture.count.size(), 1.0F);
    for_each_fragment(stream, [&](std::size_t pixel, std::size_t quad, std::size_t lane) {
        ++picture.count[pixel];
        picture.id[pixel] = primitive_of(stream, stream.quads[quad]) + 1;
        picture.depth[pixel] = stream.depths[quad][lane];
    });
    return picture;
}

bool fuses_multiply_add() {
#if defined(__x86_64__)
    return __builtin_cpu_supports("fma") != 0;
#else
    return true;
#endif
}

} // namespace tests
