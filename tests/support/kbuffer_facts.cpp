#include "tests/support/kbuffer_facts.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace support {

namespace {

/// The entries of a pixel that are not empty.
std::vector<std::vector<float>> filled_entries(const pipeline::ModifyProgram& program, const float* pixel) {
    std::vector<float> empty(program.floats_per_pixel());
    program.clear(empty.data());
    const std::size_t floats = program.floats_per_entry();
    std::vector<std::vector<float>> entries;
    for (std::size_t at = 0; at < program.k() * floats; at += floats)
        if (!std::equal(pixel + at, pixel + at + floats, empty.begin() + static_cast<std::ptrdiff_t>(at)))
            entries.emplace_back(pixel + at, pixel + at + floats);
    return entries;
}

} // namespace

std::vector<float> pixel_of(const Replay& replay, const std::vector<float>& kbuffer, std::size_t pixel) {
    const std::size_t floats = replay.frame.program->floats_per_pixel();
    const auto first = kbuffer.begin() + static_cast<std::ptrdiff_t>(pixel * floats);
    return {first, first + static_cast<std::ptrdiff_t>(floats)};
}

std::vector<float> depths_at(const pipeline::Frame& frame, const std::vector<float>& kbuffer, std::uint32_t x,
                             std::uint32_t y) {
    const pipeline::ModifyProgram& program = *frame.program;
    const std::size_t pixel = std::size_t{y} * frame.view.width + x;
    std::vector<float> depths;
    for (const auto& entry : filled_entries(program, kbuffer.data() + pixel * program.floats_per_pixel()))
        depths.push_back(entry[program.depth_slot()]);
    return depths;
}

std::vector<float> entry_of(const Replay& replay, std::size_t pixel, pipeline::QuadId quad) {
    const pipeline::FragmentStream& stream = replay.kbuffer_stream();
    const std::size_t x = pixel % stream.width, y = pixel / stream.width, lane = y % 2 * 2 + x % 2;
    std::vector<float> entry(replay.frame.program->floats_per_entry());
    replay.frame.program->make_entry(stream.fragment(quad, lane), entry.data());
    return entry;
}

std::vector<float> entries_of_chain(const Replay& replay, std::size_t pixel,
                                    const std::vector<pipeline::QuadId>& chain) {
    std::vector<float> entries(replay.frame.program->floats_per_pixel());
    replay.frame.program->clear(entries.data());
    for (auto quad = chain.rbegin(); quad != chain.rend(); ++quad)
        replay.frame.program->insert(entries.data(), entry_of(replay, pixel, *quad).data());
    return entries;
}

std::string TrueFragments::violation_at(const std::vector<float>& kbuffer, std::size_t pixel) const {
    const pipeline::ModifyProgram& program = *replay_->frame.program;
    std::multiset<std::vector<float>> unused;
    for (const pipeline::QuadId quad : quads_[pixel]) unused.insert(entry_of(*replay_, pixel, quad));
    float before = -1.0F;
    for (const auto& entry : filled_entries(program, kbuffer.data() + pixel * program.floats_per_pixel())) {
        const float depth = entry[program.depth_slot()];
        if (depth < before) return fmt::format("pixel {}: depth {} behind {}", pixel, depth, before);
        before = depth;
        const auto found = unused.find(entry);
        if (found == unused.end())
            return fmt::format("pixel {}: an entry of depth {} that no fragment explains", pixel, depth);
        unused.erase(found);
    }
    return {};
}

std::string TrueFragments::first_violation_of_l1(const std::vector<float>& kbuffer) const {
    for (std::size_t pixel = 0; pixel < quads_.size(); ++pixel)
        if (std::string violation = violation_at(kbuffer, pixel); !violation.empty()) return violation;
    return {};
}

} // namespace support
