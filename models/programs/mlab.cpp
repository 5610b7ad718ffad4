#include "models/programs/mlab.hpp"

#include "models/programs/finite.hpp"
#include "models/programs/insertion.hpp"
#include "models/programs/nearest_k.hpp"
#include "sim/check.hpp"

#include <optional>

namespace models {

namespace {

class Mlab final : public pipeline::ModifyProgram {
  public:
    Mlab(std::uint32_t k, std::optional<float> opacity) : ModifyProgram(k, floats), opacity_(opacity) {}

    std::string_view id() const override { return "mlab"; }
    std::string_view summary() const override { return "k nodes; what overflows is blended into the last"; }
    /// The insertion, and two operations for each channel and one for the transmittance of the merge.
    pipeline::ProgramCost cost() const override { return {Pass::operations(k()) + 2 * 3 + 1}; }
    /// Which fragments share the last node depends on the order in which they came.
    pipeline::OrderNeed order_need() const override { return pipeline::OrderNeed::primitive_order; }
    bool needs_texture() const override { return false; }
    bool needs_colour() const override { return true; }
    std::uint32_t depth_slot() const override { return slot; }

    // An empty node is transparent and farther than all, so merging it changes nothing.
    void clear(float* pixel) const override {
        std::fill_n(pixel, floats_per_pixel(), 0.0F);
        for (std::uint32_t i = 0; i < k(); ++i) {
            pixel[i * floats + transmittance] = 1.0F;
            pixel[i * floats + slot] = empty_depth;
        }
    }

    bool insert(float* pixel, const float* fragment) const override {
        Pass::Entry left;
        std::copy_n(fragment, floats, left.begin());
        if (opacity_)
            Pass::exchange(pixel, k(), left);
        else
            Pass::exchange_latest_first(pixel, k(), left);
        float* last = pixel + std::size_t{k() - 1} * floats;
        for (std::uint32_t channel = 0; channel < 3; ++channel)
            last[channel] = finite(last[channel] + last[transmittance] * left[channel]);
        last[transmittance] *= left[transmittance];
        return true;
    }

    void make_entry(const pipeline::Fragment& fragment, float* entry) const override {
        for (std::uint32_t channel = 0; channel < 3; ++channel)
            entry[channel] = opacity_.value_or(1.0F) * finite(fragment.rgba[channel]);
        entry[transmittance] = opacity_ ? 1.0F - *opacity_ : finite(fragment.rgba[3]);
        entry[slot] = fragment.depth;
    }

  private:
    static constexpr std::uint32_t floats = 5, transmittance = 3, slot = 4;
    using Pass = Insertion<floats, slot>;

    std::optional<float> opacity_; ///< none: fragments are nodes
};

} // namespace

std::shared_ptr<const pipeline::ModifyProgram> make_mlab(std::uint32_t k, float opacity) {
    CHECK(k >= 1 && k <= most_mlab_nodes);
    CHECK(opacity >= 0.0F && opacity <= 1.0F);
    return std::make_shared<const Mlab>(k, opacity);
}

std::shared_ptr<const pipeline::ModifyProgram> make_nodes(std::uint32_t k) {
    CHECK(k >= 1 && k <= most_mlab_nodes);
    return std::make_shared<const Mlab>(k, std::nullopt);
}

} // namespace models
