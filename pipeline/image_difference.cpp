#include "pipeline/image_difference.hpp"

#include "sim/check.hpp"

#include <cstring>

namespace pipeline {

namespace {

class PixelComparison {
  public:
    PixelComparison(const ModifyProgram& program, KBufferDifference& result)
        : program_(program),
          entry_(program.floats_per_entry()),
          sorted_(program.entries_are_sorted()),
          empty_(program.floats_per_pixel()),
          result_(result) {
        program.clear(empty_.data());
    }

    bool tied(const float* run, const float* reference) const {
        for (std::uint32_t layer = 0; layer < program_.k(); ++layer)
            if (depth(at(run, layer)) != depth(at(reference, layer))) return false;
        return true;
    }

    void compare(const float* run, const float* reference) {
        for (std::uint32_t layer = 0; layer < program_.k(); ++layer) {
            const float* mine = at(run, layer);
            const float* want = at(reference, layer);
            if (filled(want) && count(run, want) == 0) {
                ++result_.layers[layer].missing;
                ++result_.lost_fragments;
            }
            if (!filled(mine)) continue;
            const std::uint32_t before = count_before(run, mine, layer);
            if (before > 0 && before >= count(reference, mine)) ++result_.layers[layer].duplicate;
            if (layer > 0 && sorted_ && depth(mine) < depth(at(run, layer - 1))) ++result_.layers[layer].unsorted;
        }
    }

  private:
    const float* at(const float* pixel, std::uint32_t layer) const { return pixel + std::size_t{layer} * entry_; }
    float depth(const float* entry) const { return entry[program_.depth_slot()]; }
    bool equal(const float* a, const float* b) const { return std::memcmp(a, b, entry_ * sizeof(float)) == 0; }
    bool filled(const float* entry) const { return depth(entry) != depth(empty_.data()); }
    std::uint32_t count(const float* pixel, const float* entry) const {
        return count_before(pixel, entry, program_.k());
    }
    std::uint32_t count_before(const float* pixel, const float* entry, std::uint32_t end) const {
        std::uint32_t equals = 0;
        for (std::uint32_t layer = 0; layer < end; ++layer) equals += equal(at(pixel, layer), entry) ? 1U : 0U;
        return equals;
    }

    const ModifyProgram& program_;
    std::size_t entry_;
    bool sorted_; ///< entries of ranges are not: an empty one may lie between others
    std::vector<float> empty_;
    KBufferDifference& result_;
};

} // namespace

KBufferDifference compare_kbuffers(const ModifyProgram& program, std::span<const float> run,
                                   std::span<const float> reference) {
    CHECK(run.size() == reference.size());
    KBufferDifference result;
    const std::size_t floats = program.floats_per_pixel();
    result.layers.resize(program.k());
    result.wrong.resize(run.size() / floats);
    result.tied.resize(result.wrong.size());
    PixelComparison comparison(program, result);
    for (std::size_t pixel = 0; pixel < result.wrong.size(); ++pixel) {
        const float* mine = run.data() + pixel * floats;
        const float* want = reference.data() + pixel * floats;
        if (std::memcmp(mine, want, floats * sizeof(float)) == 0) continue;
        result.wrong[pixel] = 1;
        result.tied[pixel] = comparison.tied(mine, want) ? 1 : 0;
        ++result.wrong_pixels;
        comparison.compare(mine, want);
    }
    return result;
}

} // namespace pipeline
