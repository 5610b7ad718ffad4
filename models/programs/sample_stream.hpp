// What programs over a nearly sorted stream of samples share (A15, A16): entries of a distance along the view axis and
// a scalar, which is the fragment's red, and a look at every two neighbours.
#pragma once

#include "models/programs/finite.hpp"
#include "models/programs/nearly_sorted.hpp"
#include "models/programs/order_and_blend.hpp"
#include "pipeline/functional/eye_depth.hpp"
#include "pipeline/output/kbuffer.hpp"

#include <algorithm>

namespace models {

/// `Program` has between(first, second, state) for neighbours in the sorted stream, where `state` are the four floats
/// behind the entries.
template <class Program>
class SampleStream : public pipeline::ModifyProgram {
  public:
    pipeline::OrderNeed order_need() const override { return pipeline::OrderNeed::primitive_order; }
    bool needs_colour() const override { return true; }
    std::uint32_t depth_slot() const override { return slot; }

    void clear(float* pixel) const override {
        std::fill_n(pixel, floats_per_pixel(), 0.0F);
        empty_entries(pixel);
    }

    bool insert(float* pixel, const float* fragment) const override {
        const typename Sort::Entry first = Sort::push_pop(pixel, k(), fragment);
        look_at(first.data(), pixel, state(pixel));
        return true;
    }

    void make_entry(const pipeline::Fragment& fragment, float* entry) const override {
        entry[0] = finite(depth_.distance(fragment.depth));
        entry[1] = finite(fragment.rgba[0]);
    }

    bool drains() const override { return true; }
    void drain(float* pixel) const override {
        for (std::uint32_t i = 0; i + 1 < k(); ++i)
            look_at(pixel + std::size_t{i} * floats, pixel + std::size_t{i + 1} * floats, state(pixel));
        empty_entries(pixel);
    }

  protected:
    SampleStream(std::uint32_t k, const pipeline::EyeDepth& depth) : ModifyProgram(k, floats, 4), depth_(depth) {}

    float* state(float* pixel) const { return pixel + k() * floats; }

    /// Of the sort, and of the compare with the empty entry.
    std::uint32_t stream_operations() const { return Sort::operations(k()) + 2; }

  private:
    static constexpr std::uint32_t floats = 2, slot = 0;
    using Sort = NearlySorted<floats, slot>;

    void empty_entries(float* pixel) const {
        for (std::uint32_t i = 0; i < k(); ++i) {
            pixel[std::size_t{i} * floats] = sentinel_depth;
            pixel[i * floats + 1] = 0.0F;
        }
    }
    void look_at(const float* first, const float* second, float* state) const {
        if (std::min(first[0], second[0]) > sentinel_depth)
            static_cast<const Program&>(*this).between(first, second, state);
    }

    pipeline::EyeDepth depth_;
};

} // namespace models
