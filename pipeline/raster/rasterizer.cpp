#include "pipeline/raster/rasterizer.hpp"

#include <bit>

namespace pipeline {

namespace {
constexpr std::uint32_t tile_key(const Quad& quad) {
    return static_cast<std::uint32_t>(quad.y / 8) << 16U | static_cast<std::uint32_t>(quad.x / 8);
}
} // namespace

void Rasterizer::begin(const Triangle& triangle) {
    next_quad_ = triangle.first_quad;
    end_quad_ = triangle.first_quad + triangle.quads;
    std::uint32_t occupied = triangle.quads == 0 ? 0 : 1;
    if (triangle.tiles > 1)
        for (QuadId quad = next_quad_ + 1; quad < end_quad_; ++quad)
            if (tile_key(pass_->stream->quads[quad]) != tile_key(pass_->stream->quads[quad - 1])) ++occupied;
    CHECK(triangle.tiles >= occupied);
    empty_tiles_ = triangle.tiles - occupied;
    stats_.tiles += triangle.tiles;
    ++stats_.triangles;
    if (triangle.quads == 0) ++stats_.triangles_without_quads;
}

void Rasterizer::emit(QuadId id) {
    const Quad& quad = pass_->stream->quads[id];
    QuadTask task;
    task.quad = id;
    task.mask = quad.alive;
    quads_out.send(task);
    ++stats_.quads;
    stats_.fragments += static_cast<std::uint64_t>(std::popcount(quad.covered));
}

sim::Activity Rasterizer::tick() {
    bool progress = false;
    std::uint32_t quads = params_.quads_per_clk; // that may still leave at this edge
    for (std::uint32_t tiles = 0; tiles < params_.tiles_per_clk; ++tiles) {
        if (next_quad_ == end_quad_ && empty_tiles_ == 0) {
            const TriangleTask* task = triangles_in.peek();
            if (task == nullptr) break;
            begin(pass_->stream->triangles[task->triangle]);
            triangles_in.pop();
            progress = true;
        }
        if (empty_tiles_ > 0) { // a tile that holds nothing costs its visit
            --empty_tiles_;
            progress = true;
            continue;
        }
        const std::uint32_t tile = tile_key(pass_->stream->quads[next_quad_]);
        for (; next_quad_ != end_quad_ && tile_key(pass_->stream->quads[next_quad_]) == tile; --quads) {
            if (quads == 0) return sim::Activity::busy;
            if (!quads_out.ready()) return progress ? sim::Activity::busy : sim::Activity::blocked;
            emit(next_quad_++);
            progress = true;
        }
    }
    return progress ? sim::Activity::busy : sim::Activity::starved;
}

} // namespace pipeline
