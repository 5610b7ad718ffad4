#include "pipeline/output/kbuffer_memory.hpp"

#include <algorithm>

namespace pipeline {

KBufferMemory::KBufferMemory(const SurfaceLayout& layout, const ModifyProgram& program, bool split)
    : layout_(layout), program_(&program), floats_(program.floats_per_pixel()), split_(split) {
    const std::size_t pixels = static_cast<std::size_t>(layout_.blocks()) * 4;
    latest_.resize(pixels * floats_);
    latest_versions_.resize(pixels);
    if (split_) {
        memory_.resize(latest_.size());
        memory_versions_.resize(pixels);
    }
    clear();
}

void KBufferMemory::clear() {
    std::vector<float> initial(floats_);
    program_->clear(initial.data());
    for (std::size_t at = 0; at < latest_.size(); at += floats_)
        std::copy(initial.begin(), initial.end(), latest_.begin() + static_cast<std::ptrdiff_t>(at));
    std::fill(latest_versions_.begin(), latest_versions_.end(), PixelVersion{});
    memory_ = split_ ? latest_ : std::vector<float>{};
    memory_versions_ = split_ ? latest_versions_ : std::vector<PixelVersion>{};
}

void KBufferMemory::publish_block(std::uint32_t block, std::uint32_t pixels, const float* values,
                                  const PixelVersion* versions) {
    if (!split_) return;
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        if ((pixels >> pixel & 1) == 0) continue;
        const float* from = values + std::size_t{pixel} * floats_;
        std::copy(from, from + floats_, memory_.begin() + static_cast<std::ptrdiff_t>(at(block, pixel)));
        memory_versions_[std::size_t{block} * 4 + pixel] = versions[pixel];
    }
}

std::vector<float> KBufferMemory::image() const {
    std::vector<float> image(static_cast<std::size_t>(layout_.width) * layout_.rows() * floats_);
    auto out = image.begin();
    for (std::uint32_t y = 0; y < layout_.rows(); ++y)
        for (std::uint32_t x = 0; x < layout_.width; ++x) {
            const float* pixel = latest_.data() + at(layout_.block_of(x, y), y % 2 * 2 + x % 2);
            out = std::copy(pixel, pixel + floats_, out);
        }
    return image;
}

std::uint64_t KBufferMemory::lost_updates() const {
    std::uint64_t lost = 0;
    for (const PixelVersion& version : latest_versions_) lost += version.stores - version.chain;
    return lost;
}

std::uint64_t KBufferMemory::bytes() const {
    return (latest_.size() + memory_.size()) * sizeof(float) +
           (latest_versions_.size() + memory_versions_.size()) * sizeof(PixelVersion);
}

} // namespace pipeline
