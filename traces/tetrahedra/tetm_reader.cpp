#include "traces/tetrahedra/tetm_reader.hpp"

#include <bit>
#include <cmath>
#include <cstring>

namespace traces {

namespace {

static_assert(std::endian::native == std::endian::little, "the format is copied as it lies in the file");

template <class T>
T value_of(InputBytes& file, std::string_view what) {
    T value;
    std::memcpy(&value, file.take(sizeof(T), what).data(), sizeof(T));
    return value;
}

template <class T>
std::vector<T> values_of(InputBytes& file, std::size_t count, std::string_view what) {
    const std::string_view bytes = file.take(count * sizeof(T), what);
    std::vector<T> values(count);
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

bool has_place(const glm::vec3& point) {
    return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

void check_values(const InputBytes& file, const TetrahedralMesh& mesh) {
    const std::size_t vertices = mesh.positions.size();
    for (std::size_t i = 0; i < vertices; ++i) {
        file.require_at_byte(has_place(mesh.positions[i]), "a position of finite numbers, got vertex {}", i);
        file.require_at_byte(std::isfinite(mesh.scalars[i]), "a finite scalar, got {} at vertex {}", mesh.scalars[i],
                             i);
    }
    for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i)
        for (const std::uint32_t vertex : mesh.tetrahedra[i])
            file.require_at_byte(vertex < vertices, "a vertex below {}, got {} in tetrahedron {}", vertices, vertex, i);
}

} // namespace

TetrahedralMesh read_tetm(InputBytes file) {
    const std::string_view magic = file.take(4, "magic");
    file.require_at_byte(magic == "TETM", "the magic 'TETM', got {}", in_quotes(magic));
    const auto version = value_of<std::uint32_t>(file, "version");
    file.require_at_byte(version == 1, "version 1, got {}", version);
    const auto vertices = value_of<std::uint32_t>(file, "vertex count");
    const auto tetrahedra = value_of<std::uint32_t>(file, "tetrahedron count");
    file.require_at_byte(vertices >= 1 && tetrahedra >= 1, "at least one vertex and one tetrahedron, got {} and {}",
                         vertices, tetrahedra);
    file.take(8, "scalar minimum and maximum"); // measured again from the scalars
    const std::uint64_t expected = std::uint64_t{vertices} * 16 + std::uint64_t{tetrahedra} * 16;
    file.require_at_byte(expected == file.left(), "{} bytes for {} vertices and {} tetrahedra, got {}", expected,
                         vertices, tetrahedra, file.left());
    // An index list has to be counted in 32 bits.
    file.require_at_byte(tetrahedra <= 357'913'941, "at most 357,913,941 tetrahedra, got {}", tetrahedra);

    TetrahedralMesh mesh;
    mesh.name = "tetrahedra";
    mesh.positions = values_of<glm::vec3>(file, vertices, "positions");
    mesh.scalars = values_of<float>(file, vertices, "scalars");
    mesh.tetrahedra = values_of<std::array<std::uint32_t, 4>>(file, tetrahedra, "tetrahedra");
    check_values(file, mesh);
    return mesh;
}

} // namespace traces
