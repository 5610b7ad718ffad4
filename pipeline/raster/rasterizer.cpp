#include "pipeline/raster/rasterizer.hpp"

#include <bit>

namespace pipeline {

// Of the 8x8 pixels that a quad's triangle is visited for, whatever the sample.
std::uint32_t Rasterizer::tile_key(QuadId id) const {
    const Quad& quad = pass_->stream->quads[id];
    return pass_->layout.pixel_row(quad.y) / 8 << 16U | static_cast<std::uint32_t>(quad.x / 8);
}

void Rasterizer::begin(const Triangle& triangle) {
    next_quad_ = triangle.first_quad;
    end_quad_ = triangle.first_quad + triangle.quads;
    std::uint32_t occupied = triangle.quads == 0 ? 0 : 1;
    if (triangle.tiles > 1)
        for (QuadId quad = next_quad_ + 1; quad < end_quad_; ++quad)
            if (tile_key(quad) != tile_key(quad - 1)) ++occupied;
    CHECK(triangle.tiles >= occupied);
    empty_tiles_ = triangle.tiles - occupied;
    stats_.tiles += triangle.tiles;
    ++stats_.triangles;
    if (triangle.quads == 0) ++stats_.triangles_without_quads;
}

// Sends the task that begins with this quad; returns the first quad behind it.
QuadId Rasterizer::emit(QuadId first) {
    QuadTask task;
    task.quad = first;
    std::uint32_t covered = 0;
    const std::uint32_t sample_quads = pass_->sample_quads(first);
    for (std::uint32_t n = 0; n < sample_quads; ++n) {
        const Quad& quad = pass_->stream->quads[first + n];
        task.mask |= std::uint32_t{quad.alive} << 4 * n;
        covered |= quad.covered;
    }
    quads_out.send(task);
    ++stats_.quads;
    stats_.fragments += static_cast<std::uint64_t>(std::popcount(covered));
    return first + sample_quads;
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
        const std::uint32_t tile = tile_key(next_quad_);
        for (; next_quad_ != end_quad_ && tile_key(next_quad_) == tile; --quads) {
            if (quads == 0) return sim::Activity::busy;
            if (!quads_out.ready()) return progress ? sim::Activity::busy : sim::Activity::blocked;
            next_quad_ = emit(next_quad_);
            progress = true;
        }
    }
    return progress ? sim::Activity::busy : sim::Activity::starved;
}

} // namespace pipeline
