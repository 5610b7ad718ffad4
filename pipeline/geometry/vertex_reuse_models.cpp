#include "pipeline/geometry/vertex_reuse_models.hpp"

#include "sim/check.hpp"

namespace pipeline {

FifoReuse::FifoReuse(std::uint32_t entries, std::uint32_t warp_vertices, std::uint32_t group_triangles)
    : entries_(entries), warp_vertices_(warp_vertices), group_triangles_(group_triangles) {
    CHECK(entries >= 3);
}

void FifoReuse::flush() {
    flushed_ = next_;
    warp_ = 0;
    group_ = 0;
}

void FifoReuse::begin_draw(std::uint32_t vertex_count) {
    flush();
    if (vertex_count > run_of_.size()) run_of_.resize(vertex_count, 0);
}

ReuseResult FifoReuse::primitive(const std::array<std::uint32_t, 3>& vertices, std::size_t corners) {
    std::uint32_t misses = 0; // a vertex that occurs twice counts twice here
    for (std::size_t i = 0; i < corners; ++i) misses += held(vertices[i]) ? 0 : 1;
    const bool warp_full = warp_vertices_ != 0 && warp_ + misses > warp_vertices_;
    const bool group_full = group_triangles_ != 0 && group_ == group_triangles_;
    if (warp_full || group_full) flush();
    ReuseResult result;
    for (std::size_t i = 0; i < corners; ++i) {
        const std::uint32_t vertex = vertices[i];
        if (!held(vertex)) {
            CHECK_MSG(next_ != 0, "2^32 vertices shaded in one run");
            run_of_[vertex] = next_++;
            ++warp_;
            result.missed = static_cast<std::uint8_t>(result.missed | 1U << i);
        }
        result.sequences[i] = run_of_[vertex];
    }
    ++group_;
    return result;
}

LruReuse::LruReuse(std::uint32_t entries) : slots_(std::size_t{entries} + 1) { CHECK(entries >= 3); }

void LruReuse::begin_draw(std::uint32_t vertex_count) {
    used_ = 1;
    slots_[0] = {};
    if (vertex_count > slot_of_.size()) slot_of_.resize(vertex_count, 0);
}

void LruReuse::take_out(std::uint32_t slot) {
    const Slot& out = slots_[slot];
    slots_[out.older].newer = out.newer;
    slots_[out.newer].older = out.older;
}

void LruReuse::put_newest(std::uint32_t slot) {
    const std::uint32_t before = slots_[0].older; // the head's elder neighbour is the newest vertex
    slots_[slot].older = before;
    slots_[slot].newer = 0;
    slots_[before].newer = slot;
    slots_[0].older = slot;
}

std::uint32_t LruReuse::free_slot() {
    if (used_ < slots_.size()) return used_++;
    const std::uint32_t oldest = slots_[0].newer;
    take_out(oldest);
    return oldest;
}

ReuseResult LruReuse::primitive(const std::array<std::uint32_t, 3>& vertices, std::size_t corners) {
    ReuseResult result;
    for (std::size_t i = 0; i < corners; ++i) {
        const std::uint32_t vertex = vertices[i];
        if (held(vertex)) {
            take_out(slot_of_[vertex]);
        } else {
            CHECK_MSG(next_ != 0, "2^32 vertices shaded in one run");
            const std::uint32_t slot = free_slot();
            slots_[slot].vertex = vertex;
            slots_[slot].run = next_++;
            slot_of_[vertex] = slot;
            result.missed = static_cast<std::uint8_t>(result.missed | 1U << i);
        }
        put_newest(slot_of_[vertex]);
        result.sequences[i] = slots_[slot_of_[vertex]].run;
    }
    return result;
}

void MesaReuse::begin_draw(std::uint32_t vertex_count, bool indexed) {
    flushed_ = next_;
    indices_ = 0;
    indexed_ = indexed;
    if (indexed || vertex_count <= table_entries)
        table_.resize(table_entries);
    else
        table_.resize(vertex_count);
}

ReuseResult MesaReuse::primitive(const std::array<std::uint32_t, 3>& vertices, std::size_t corners) {
    if (indexed_ && indices_ + corners > run_indices) {
        flushed_ = next_;
        indices_ = 0;
    }
    ReuseResult result;
    for (std::size_t i = 0; i < corners; ++i) {
        Entry& entry = entry_of(vertices[i]);
        if (entry.vertex != vertices[i] || entry.run < flushed_) {
            CHECK_MSG(next_ != 0, "2^32 vertices shaded in one run");
            entry = {vertices[i], next_++};
            result.missed = static_cast<std::uint8_t>(result.missed | 1U << i);
        }
        result.sequences[i] = entry.run;
    }
    indices_ += static_cast<std::uint32_t>(corners);
    return result;
}

namespace {
std::variant<FifoReuse, LruReuse, MesaReuse> model_of(const VertexReuseParams& params) {
    switch (params.model) {
    case ReuseModel::fifo:
        return FifoReuse(params.entries, 0, 0);
    case ReuseModel::batch:
        return FifoReuse(params.entries, params.warp_vertices, params.group_triangles);
    case ReuseModel::lru:
        return LruReuse(params.entries);
    case ReuseModel::mesa:
        break;
    }
    return MesaReuse();
}
} // namespace

VertexReuseModel::VertexReuseModel(const VertexReuseParams& params) : model_(model_of(params)) {}

void VertexReuseModel::begin_draw(std::uint32_t vertex_count, bool indexed) {
    if (MesaReuse* mesa = std::get_if<MesaReuse>(&model_))
        mesa->begin_draw(vertex_count, indexed);
    else if (LruReuse* lru = std::get_if<LruReuse>(&model_))
        lru->begin_draw(vertex_count);
    else
        std::get_if<FifoReuse>(&model_)->begin_draw(vertex_count);
}

std::uint32_t VertexReuseModel::runs() const {
    return std::visit([](const auto& model) { return model.runs(); }, model_);
}

} // namespace pipeline
