#include "pipeline/fragment/texture_cache.hpp"

#include <algorithm>

namespace pipeline {

TextureCache::TextureCache(const TextureParams& params, std::uint32_t line_targets)
    : ways_(params.l1_ways), line_targets_(line_targets) {
    const std::size_t line_bytes = std::size_t{TextureParams::line_bytes} * std::max(line_targets, 1U);
    sets_ = params.l1_bytes / (line_bytes * ways_);
    if (sets_ == 0 && params.l1_bytes >= line_bytes) { // smaller than one full set: as many ways as fit
        ways_ = static_cast<std::uint32_t>(params.l1_bytes / line_bytes);
        sets_ = 1;
    }
    lines_.resize(sets_ * ways_);
    if (line_targets_ == 0) return;
    data_.resize(lines_.size() * 16 * line_targets_);
    versions_.resize(lines_.size() * 4);
}

// The targets of one block fall into neighbouring sets, and neighbouring blocks into different ones.
std::size_t TextureCache::set_of(std::uint64_t tag) const {
    const std::uint64_t line = tag >> 1U;
    return (is_kbuffer(tag) ? line / 64 * (64 / 16) + line % 64 : line) % sets_;
}

std::uint32_t TextureCache::find(std::uint64_t tag) {
    if (sets_ == 0) return none;
    const std::size_t first = set_of(tag) * ways_;
    for (std::size_t at = first; at < first + ways_; ++at) {
        Line& line = lines_[at];
        if (line.tag != tag) continue;
        line.used = ++clock_;
        return static_cast<std::uint32_t>(at);
    }
    return none;
}

std::uint32_t TextureCache::reserve(std::uint64_t tag) {
    if (sets_ == 0) return none;
    const std::size_t first = set_of(tag) * ways_;
    std::uint32_t best = none;
    for (std::size_t at = first; at < first + ways_; ++at) {
        if (lines_[at].pending) continue;
        if (best == none || lines_[at].used < lines_[best].used) best = static_cast<std::uint32_t>(at);
    }
    if (best != none) lines_[best] = {tag, ++clock_, true, 0};
    return best;
}

void TextureCache::drop_texture_lines(std::uint64_t begin, std::uint64_t end) {
    for (Line& line : lines_)
        if (!is_kbuffer(line.tag) && line.tag >> 1U >= begin && line.tag >> 1U < end) line = {};
}

void TextureCache::drop_kbuffer_lines() {
    ++generation_;
    for (Line& line : lines_)
        if (is_kbuffer(line.tag)) line = {};
}

void TextureCache::drop_kbuffer_block(std::uint32_t block, std::uint32_t parts) {
    for (std::uint32_t part = 0; part < parts; ++part)
        if (const std::uint32_t index = find(kbuffer_tag(block, part)); index != none) lines_[index] = {};
}

} // namespace pipeline
