#include "models/programs/order_and_blend.hpp"

#include "models/programs/finite.hpp"
#include "models/programs/nearly_sorted.hpp"
#include "sim/check.hpp"

namespace models {

namespace {

class OrderAndBlend final : public pipeline::ModifyProgram {
  public:
    OrderAndBlend(std::uint32_t k, float opacity) : ModifyProgram(k, floats, 4), opacity_(opacity) {}

    std::string_view id() const override { return "order-and-blend"; }
    std::string_view summary() const override { return "sorts a nearly sorted stream and composites it (A7)"; }
    /// The sort, a compare with the empty entry, and of the composite two multiplications for the weights and two
    /// operations for each channel.
    pipeline::ProgramCost cost() const override { return {Sort::operations(k()) + 1 + 2 + 2 * 3}; }
    pipeline::OrderNeed order_need() const override { return pipeline::OrderNeed::primitive_order; }
    bool needs_texture() const override { return false; }
    bool needs_colour() const override { return true; }
    std::uint32_t depth_slot() const override { return slot; }

    void clear(float* pixel) const override {
        std::fill_n(pixel, floats_per_pixel(), 0.0F);
        for (std::uint32_t i = 0; i < k(); ++i) pixel[i * floats + slot] = sentinel_depth;
        state(pixel)[3] = 1.0F;
    }

    bool insert(float* pixel, const float* fragment) const override {
        composite(state(pixel), Sort::push_pop(pixel, k(), fragment).data());
        return true;
    }

    void make_entry(const pipeline::Fragment& fragment, float* entry) const override {
        for (int channel = 0; channel < 3; ++channel) entry[channel] = finite(fragment.rgba[channel]);
        entry[slot] = fragment.depth;
    }

    bool drains() const override { return true; }
    void drain(float* pixel) const override {
        for (std::uint32_t i = 0; i < k(); ++i) {
            float* entry = pixel + std::size_t{i} * floats;
            composite(state(pixel), entry);
            std::fill_n(entry, slot, 0.0F);
            entry[slot] = sentinel_depth;
        }
    }

  private:
    static constexpr std::uint32_t floats = 4, slot = 3;
    using Sort = NearlySorted<floats, slot>;

    float* state(float* pixel) const { return pixel + std::size_t{k()} * floats; }

    void composite(float* state, const float* entry) const {
        if (!(entry[slot] > sentinel_depth)) return;
        const float weight = state[3] * opacity_;
        for (int channel = 0; channel < 3; ++channel) state[channel] = finite(state[channel] + weight * entry[channel]);
        state[3] *= 1.0F - opacity_;
    }

    float opacity_;
};

} // namespace

std::shared_ptr<const pipeline::ModifyProgram> make_order_and_blend(std::uint32_t k, float opacity) {
    CHECK(k >= 1 && k < 64);
    CHECK(opacity >= 0.0F && opacity <= 1.0F);
    return std::make_shared<const OrderAndBlend>(k, opacity);
}

} // namespace models
