// Which vertices of a list of primitives have been shaded already: models of the post-transform cache without time.
//
// Each model gives every shader run a sequence number, counting from 1, and tells for each corner of a primitive which
// run produced it. All are exact replacements of each other. Sources: specification 004, sections 2.1, 9.2; the warp
// and group rule is that of meshoptimizer's vertex cache analyzer; the batches are what Mesa's llvmpipe was measured to
// do.
#pragma once

#include "sim/described.hpp"

#include <array>
#include <cstdint>
#include <tuple>
#include <variant>
#include <vector>

namespace pipeline {

enum class ReuseModel : std::uint8_t {
    fifo,  ///< the last `entries` shaded vertices
    batch, ///< fifo that is emptied when a warp of vertices or a group of triangles is full
    mesa,  ///< runs of 1023 indices (of lines and points 1024), each with a direct-mapped table of 256 entries
    lru,   ///< the `entries` shaded vertices that were used last
};

} // namespace pipeline

template <>
struct sim::EnumNames<pipeline::ReuseModel> {
    static constexpr std::array<std::string_view, 4> names{"fifo", "batch", "mesa", "lru"};
};

namespace pipeline {

struct VertexReuseParams {
    ReuseModel model = ReuseModel::fifo;
    std::uint32_t entries = 24;
    std::uint32_t warp_vertices = 32;
    std::uint32_t group_triangles = 0;
    std::uint32_t vertices_per_clk = 2;

    static constexpr auto fields() {
        using P = VertexReuseParams;
        return std::tuple{
            sim::field<&P::model>(
                "Which vertices are still held: those shaded last (fifo) or used last (lru), those of "
                "the present batch, as far as entries hold them (batch), or as in llvmpipe (mesa)"),
            sim::field<&P::entries>("Shaded vertices held (fifo, lru, batch)").unit("vertices").range(3, 1U << 20U),
            sim::field<&P::warp_vertices>("Vertices shaded together, then forgotten (batch); 0: no limit")
                .unit("vertices")
                .at_most(1U << 20U),
            sim::field<&P::group_triangles>(
                "Triangles drawn together, then forgotten (batch): a third of the batch's indices, rounded "
                "down, so 10, 32 or 128 for batches of 32, 96 or 384 indices; 0: no limit")
                .unit("triangles")
                .at_most(1U << 20U),
            sim::field<&P::vertices_per_clk>("Vertices sent to be shaded").unit("vertices/cycle").range(1, 64)};
    }
};
static_assert(sim::fully_described<VertexReuseParams>);

/// The shader runs that produced the corners of a primitive, and which of them this primitive caused.
struct ReuseResult {
    std::array<std::uint32_t, 3> sequences{}; ///< 0 where there is no such corner
    std::uint8_t missed = 0;                  ///< bit i: corner i is shaded for this primitive
};

/// First in, first out, with optional limits of a warp and of a primitive group.
class FifoReuse {
  public:
    /// `warp_vertices` and `group_triangles`: 0 = no limit. entries >= 3.
    FifoReuse(std::uint32_t entries, std::uint32_t warp_vertices, std::uint32_t group_triangles);
    void begin_draw(std::uint32_t vertex_count);
    ReuseResult primitive(const std::array<std::uint32_t, 3>& vertices, std::size_t corners);
    ReuseResult triangle(const std::array<std::uint32_t, 3>& vertices) { return primitive(vertices, 3); }
    std::uint32_t runs() const { return next_ - 1; } ///< shader runs so far

  private:
    bool held(std::uint32_t vertex) const {
        const std::uint32_t run = run_of_[vertex];
        return run >= flushed_ && next_ - run <= entries_;
    }
    void flush();

    std::uint32_t entries_, warp_vertices_, group_triangles_;
    std::uint32_t next_ = 1;
    std::uint32_t flushed_ = 1;         ///< runs before this one are forgotten
    std::uint32_t warp_ = 0;            ///< vertices in the present warp
    std::uint32_t group_ = 0;           ///< triangles in the present group
    std::vector<std::uint32_t> run_of_; ///< by vertex: its latest run, 0 = none
};

/// Least recently used: a vertex that is used again stays longer.
class LruReuse {
  public:
    explicit LruReuse(std::uint32_t entries); ///< at least 3
    void begin_draw(std::uint32_t vertex_count);
    ReuseResult primitive(const std::array<std::uint32_t, 3>& vertices, std::size_t corners);
    ReuseResult triangle(const std::array<std::uint32_t, 3>& vertices) { return primitive(vertices, 3); }
    std::uint32_t runs() const { return next_ - 1; }

  private:
    /// A held vertex in a ring by time of use; slot 0 is the ring's head.
    struct Slot {
        std::uint32_t vertex = 0;
        std::uint32_t run = 0;
        std::uint32_t older = 0, newer = 0;
    };
    bool held(std::uint32_t vertex) const {
        const std::uint32_t slot = slot_of_[vertex];
        return slot != 0 && slot < used_ && slots_[slot].vertex == vertex;
    }
    std::uint32_t free_slot();
    void take_out(std::uint32_t slot);
    void put_newest(std::uint32_t slot);

    std::uint32_t next_ = 1;
    std::uint32_t used_ = 1;             ///< slots below hold vertices, or are the head
    std::vector<Slot> slots_;            ///< the head, then `entries` vertices
    std::vector<std::uint32_t> slot_of_; ///< by vertex: where it was put last; 0: nowhere
};

/// Mesa's vertex batches. Without an index buffer each vertex is shaded once.
class MesaReuse {
  public:
    static constexpr std::uint32_t run_indices = 1024; ///< rounded down to whole primitives
    static constexpr std::uint32_t table_entries = 256;

    void begin_draw(std::uint32_t vertex_count, bool indexed);
    ReuseResult primitive(const std::array<std::uint32_t, 3>& vertices, std::size_t corners);
    ReuseResult triangle(const std::array<std::uint32_t, 3>& vertices) { return primitive(vertices, 3); }
    std::uint32_t runs() const { return next_ - 1; }

  private:
    struct Entry {
        std::uint32_t vertex = 0;
        std::uint32_t run = 0; ///< 0: none
    };
    Entry& entry_of(std::uint32_t vertex) { return table_[vertex % table_.size()]; }

    std::uint32_t next_ = 1;
    std::uint32_t flushed_ = 1; ///< runs before this one are forgotten
    std::uint32_t indices_ = 0; ///< of the present batch
    bool indexed_ = true;
    std::vector<Entry> table_ = std::vector<Entry>(table_entries);
};

/// The configured one of them.
class VertexReuseModel {
  public:
    explicit VertexReuseModel(const VertexReuseParams& params);
    /// Forgets everything; vertices of the coming primitives are below `vertex_count`.
    void begin_draw(std::uint32_t vertex_count, bool indexed);
    /// `vertices` of which the first `corners` count, 1 to 3.
    ReuseResult primitive(const std::array<std::uint32_t, 3>& vertices, std::size_t corners) {
        if (FifoReuse* fifo = std::get_if<FifoReuse>(&model_)) return fifo->primitive(vertices, corners);
        return std::visit([&](auto& model) { return model.primitive(vertices, corners); }, model_);
    }
    ReuseResult triangle(const std::array<std::uint32_t, 3>& vertices) { return primitive(vertices, 3); }
    std::uint32_t runs() const;

  private:
    std::variant<FifoReuse, LruReuse, MesaReuse> model_;
};

} // namespace pipeline
