// A1: stream batching. Triangles keep their order and are cut into draws of a bounded number of vertices, whose indices
// then get by with 16 bits (specification 004, section 3.1).
#include "sim/check.hpp"
#include "sim/counted.hpp"
#include "traces/preparation/conservation.hpp"
#include "traces/preparation/rebuild.hpp"
#include "traces/preparation/steps.hpp"
#include "traces/preparation/table.hpp"

#include <fmt/format.h>
#include <limits>

namespace traces {

enum class BatchIndex : std::uint8_t { shortest, u32 };

} // namespace traces

template <>
struct sim::EnumNames<traces::BatchIndex> {
    static constexpr std::array<std::string_view, 2> names{"shortest", "u32"};
};

namespace traces {

namespace {

struct BatchParams {
    std::uint32_t vertices = 65536;
    std::uint32_t triangles = 0;
    BatchIndex index = BatchIndex::shortest;

    static constexpr auto fields() {
        return std::tuple(
            sim::field<&BatchParams::vertices>(
                "distinct vertices of a batch at most; 16-bit indices reach 65536; 0: no "
                "limit")
                .unit("vertices"),
            sim::field<&BatchParams::triangles>("triangles of a batch at most; 0: no limit").unit("triangles"),
            sim::field<&BatchParams::index>("width of indices: 16 bits where they reach, or always 32"));
    }
};
static_assert(sim::fully_described<BatchParams>);

/// How many triangles each batch takes.
std::vector<std::size_t> batch_sizes(const TriangleMesh& mesh, std::uint32_t vertices, std::uint32_t triangles) {
    std::vector<std::size_t> batch_of(mesh.vertices, 0); // the latest, counting from 1
    std::vector<std::size_t> sizes{0};
    std::uint32_t distinct = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::array<std::uint32_t, 3> corners{mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
        const auto added = [&] {
            std::uint32_t count = 0;
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const bool again =
                    (corner > 0 && corners[corner] == corners[0]) || (corner > 1 && corners[corner] == corners[1]);
                count += !again && batch_of[corners[corner]] != sizes.size() ? 1 : 0;
            }
            return count;
        };
        if (added() > vertices - distinct || (triangles != 0 && sizes.back() == triangles)) {
            sizes.push_back(0);
            distinct = 0;
        }
        distinct += added();
        for (const std::uint32_t corner : corners) batch_of[corner] = sizes.size();
        ++sizes.back();
    }
    return sizes;
}

Applied apply(Scene scene, const BatchParams& params) {
    const DrawnTriangles before = drawn_triangles(scene);
    if (params.vertices == 1 || params.vertices == 2)
        throw sim::InputError(fmt::format("batch: vertices: expected 0 or at least 3, got {}", params.vertices));
    const std::uint32_t vertices_of_batch =
        params.vertices == 0 ? std::numeric_limits<std::uint32_t>::max() : params.vertices;
    const std::size_t draws = scene.draws.size();
    const std::uint64_t vertices = scene.vertices;
    Applied applied;
    applied.scene = rebuild_scene(std::move(scene), TopologyWanted::list, [&](TriangleMesh mesh) {
        std::vector<PreparedPart> parts;
        for (TriangleMesh& part : cut_into_batches(std::move(mesh), vertices_of_batch, params.triangles)) {
            if (params.index == BatchIndex::u32) part.index_type = pipeline::IndexType::u32;
            parts.push_back({std::move(part)});
        }
        return parts;
    });
    check_same_triangles(before, drawn_triangles(applied.scene), false);
    applied.notes.push_back(fmt::format("{} became {}, {} {}", sim::counted(draws, "draw"), applied.scene.draws.size(),
                                        sim::counted(vertices, "vertex"), applied.scene.vertices));
    return applied;
}

} // namespace

std::vector<TriangleMesh> cut_into_batches(TriangleMesh mesh, std::uint32_t vertices, std::uint32_t triangles) {
    CHECK(mesh.topology == pipeline::Topology::triangles && vertices >= 3);
    if (mesh.index_type != pipeline::IndexType::none) mesh.index_type = pipeline::IndexType::u16;
    const std::vector<std::size_t> sizes = batch_sizes(mesh, vertices, triangles);
    std::vector<TriangleMesh> batches;
    if (sizes.size() == 1) {
        batches.push_back(std::move(mesh));
        return batches;
    }
    std::size_t first = 0;
    for (const std::size_t size : sizes) {
        batches.push_back(cut_mesh(mesh, first, size));
        batches.back().name = fmt::format("{} batch {}", mesh.name, batches.size() - 1);
        CHECK(batches.back().vertices <= vertices);
        first += size;
    }
    return batches;
}

Preparation batch_preparation() {
    return make_preparation<BatchParams>(
        "batch", "draws of a bounded number of vertices, with 16-bit indices where they do (A1)", apply);
}

} // namespace traces
