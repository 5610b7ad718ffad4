// The texture L1 cache of one fragment pipe.
//
// Modelled: set-associative, LRU; lines of material textures, surfaces and peeled layers as tags with a pending state
// (read-only data needs no bytes); lines of the k-buffer as snapshots of the bytes and versions of the array read that
// filled them, because this cache is not coherent with the ROPs. Source: specification 004, section 7.1 (read value
// rule) and section 7 (tex_l1 parameters).
#pragma once

#include "pipeline/fragment/fragment_params.hpp"
#include "pipeline/output/kbuffer_memory.hpp"
#include "sim/described.hpp"
#include "sim/stats.hpp"
#include "sim/time.hpp"

#include <cstdint>
#include <vector>

namespace pipeline {

struct TextureCacheStats {
    sim::Counter texture_hits, texture_misses, kbuffer_hits, kbuffer_misses, kbuffer_merged, invalidations;

    static constexpr auto fields() {
        using S = TextureCacheStats;
        return std::tuple{
            sim::field<&S::texture_hits>("Texture and depth-layer lookups that hit a present or pending line")
                .unit("lines"),
            sim::field<&S::texture_misses>("Texture and depth-layer lookups that went to memory").unit("lines"),
            sim::field<&S::kbuffer_hits>("k-buffer lookups that hit").unit("lines"),
            sim::field<&S::kbuffer_misses>("k-buffer lookups that went to the memory side").unit("lines"),
            sim::field<&S::kbuffer_merged>("k-buffer lookups that joined a pending miss of the same line")
                .unit("lines"),
            sim::field<&S::invalidations>("Times all or some k-buffer lines were dropped").unit("events")};
    }
};
static_assert(sim::fully_described<TextureCacheStats>);

class TextureCache {
  public:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    /// @param line_targets render targets of one block that share a line: 1, or all of them when reads are atomic;
    ///                     0 when no k-buffer is read through this cache
    TextureCache(const TextureParams& params, std::uint32_t line_targets);

    bool enabled() const { return !lines_.empty(); }

    /// Line of read-only data; `line` is an address / 64.
    std::uint32_t find_texture(std::uint64_t line) { return find(line << 1U); }
    /// Reserves a line whose data is on its way; none when every way of the set is pending.
    std::uint32_t reserve_texture(std::uint64_t line) { return reserve(line << 1U); }
    bool pending(std::uint32_t index) const { return lines_[index].pending; }
    void filled(std::uint32_t index) { lines_[index].pending = false; }

    /// Line `part` (target / line_targets) of block `block`.
    std::uint32_t find_kbuffer(std::uint32_t block, std::uint32_t part) { return find(kbuffer_tag(block, part)); }
    /// Reserves a line for the values that are asked for now, which later lookups join; none
    /// when every way of the set is pending.
    std::uint32_t reserve_kbuffer(std::uint32_t block, std::uint32_t part) { return reserve(kbuffer_tag(block, part)); }
    /// Bytes of pixel `pixel`, render target `target` within the line; 4 floats.
    float* data(std::uint32_t index, std::uint32_t pixel, std::uint32_t target) {
        return data_.data() + ((static_cast<std::size_t>(index) * 4 + pixel) * line_targets_ + target) * 4;
    }
    PixelVersion& version(std::uint32_t index, std::uint32_t pixel) {
        return versions_[index * std::size_t{4} + pixel];
    }

    /// When the array behind the cache was read for this line.
    sim::Cycle& filled_at(std::uint32_t index) { return lines_[index].filled_at; }

    /// Of read-only data that changed: lines [begin, end), none of them pending.
    void drop_texture_lines(std::uint64_t begin, std::uint64_t end);
    void drop_kbuffer_lines();
    void drop_kbuffer_block(std::uint32_t block, std::uint32_t parts);
    /// Changes whenever lines were dropped: a fill asked for earlier must not be kept.
    std::uint32_t generation() const { return generation_; }

  private:
    static constexpr std::uint64_t no_tag = ~std::uint64_t{1};
    struct Line {
        std::uint64_t tag = no_tag;
        std::uint64_t used = 0;
        bool pending = false;
        sim::Cycle filled_at = 0; ///< of a line of the k-buffer
    };
    static constexpr std::uint64_t kbuffer_tag(std::uint32_t block, std::uint32_t part) {
        return (static_cast<std::uint64_t>(block) * 64 + part) << 1U | 1U;
    }
    static constexpr bool is_kbuffer(std::uint64_t tag) { return (tag & 1U) != 0; }
    std::size_t set_of(std::uint64_t tag) const;
    std::uint32_t find(std::uint64_t tag);
    std::uint32_t reserve(std::uint64_t tag);

    std::uint32_t ways_;
    std::uint32_t line_targets_;
    std::size_t sets_ = 0;
    std::vector<Line> lines_;
    std::vector<float> data_;
    std::vector<PixelVersion> versions_;
    std::uint64_t clock_ = 0;
    std::uint32_t generation_ = 0;
};

} // namespace pipeline
