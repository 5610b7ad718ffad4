#include "models/programs/volume.hpp"

#include "models/programs/finite.hpp"
#include "models/programs/nearly_sorted.hpp"
#include "models/programs/order_and_blend.hpp"
#include "sim/check.hpp"

namespace models {

namespace {

constexpr std::uint32_t floats = 2, slot = 0;
using Sort = NearlySorted<floats, slot>;

class Volume final : public pipeline::ModifyProgram {
  public:
    explicit Volume(const VolumeSetup& setup)
        : ModifyProgram(setup.k, floats, 4),
          table_(setup.transfer, setup.longest_gap, setup.table_scalars, setup.table_lengths),
          depth_(setup.depth) {}

    std::string_view id() const override { return "volume"; }
    std::string_view summary() const override { return "composites pre-integrated gaps between samples (A16)"; }
    /// The sort, a compare of the nearer with the empty entry, the length, the texture fetch (its lookup counts as
    /// one), opacity from the optical depth (a multiplication, an exponential, a difference), three multiplications for
    /// the premultiplied colour, and the composite: a difference and two operations for each of four channels.
    pipeline::ProgramCost cost() const override { return {Sort::operations(k()) + 2 + 1 + 1 + 3 + 3 + 1 + 2 * 4}; }
    pipeline::OrderNeed order_need() const override { return pipeline::OrderNeed::primitive_order; }
    bool needs_texture() const override { return true; }
    bool needs_colour() const override { return true; }
    std::uint32_t depth_slot() const override { return slot; }

    void clear(float* pixel) const override {
        std::fill_n(pixel, floats_per_pixel(), 0.0F);
        for (std::uint32_t i = 0; i < k(); ++i) pixel[i * floats + slot] = sentinel_depth;
    }

    bool insert(float* pixel, const float* fragment) const override {
        const Sort::Entry first = Sort::push_pop(pixel, k(), fragment);
        composite(first.data(), pixel, pixel + k() * floats);
        return true;
    }

    void make_entry(const pipeline::Fragment& fragment, float* entry) const override {
        entry[0] = finite(depth_.distance(fragment.depth));
        entry[1] = finite(fragment.rgba[0]);
    }

    bool drains() const override { return true; }
    void drain(float* pixel) const override {
        float* state = pixel + k() * floats;
        for (std::uint32_t i = 0; i + 1 < k(); ++i) composite(pixel + i * floats, pixel + (i + 1) * floats, state);
        for (std::uint32_t i = 0; i < k(); ++i) {
            pixel[i * floats] = sentinel_depth;
            pixel[i * floats + 1] = 0.0F;
        }
    }

  private:
    void composite(const float* first, const float* second, float* state) const {
        if (!(std::min(first[0], second[0]) > sentinel_depth)) return;
        const float length = std::max(0.0F, finite(second[0] - first[0]));
        const glm::vec4 gap = table_.gap(first[1], second[1], length);
        const float left = 1.0F - state[3];
        for (int channel = 0; channel < 4; ++channel) state[channel] = finite(state[channel] + left * gap[channel]);
    }

    PreintegratedTable table_;
    pipeline::EyeDepth depth_;
};

} // namespace

std::shared_ptr<const pipeline::ModifyProgram> make_volume(const VolumeSetup& setup) {
    CHECK(setup.k >= 1 && setup.k <= 64);
    return std::make_shared<const Volume>(setup);
}

} // namespace models
