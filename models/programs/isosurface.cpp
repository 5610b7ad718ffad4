#include "models/programs/isosurface.hpp"

#include "models/programs/finite.hpp"
#include "models/programs/nearest_k.hpp"
#include "models/programs/nearly_sorted.hpp"
#include "models/programs/order_and_blend.hpp"
#include "sim/check.hpp"

#include <cmath>
#include <fmt/format.h>

namespace models {

namespace {

constexpr std::uint32_t floats = 2, slot = 0;
using Sort = NearlySorted<floats, slot>;

class Isosurface final : public pipeline::ModifyProgram {
  public:
    explicit Isosurface(const IsosurfaceSetup& setup)
        : ModifyProgram(setup.k, floats, 4), iso_(setup.iso_values), depth_(setup.depth) {}

    std::string_view id() const override { return "isosurface"; }
    std::string_view summary() const override { return "the nearest crossing of iso-values along the ray (A15)"; }
    /// The sort, a compare of the nearer with the empty entry, the two differences, and for each iso-value two compares
    /// and whether they differ; a difference, a division, a multiplication and an addition for the hit; its count; the
    /// test; and three moves.
    pipeline::ProgramCost cost() const override {
        return {Sort::operations(k()) + 2 + 2 + static_cast<std::uint32_t>(iso_.size()) * (3 + 4 + 1 + 1 + 3)};
    }
    pipeline::OrderNeed order_need() const override { return pipeline::OrderNeed::primitive_order; }
    bool needs_texture() const override { return false; }
    bool needs_colour() const override { return true; }
    std::uint32_t depth_slot() const override { return slot; }

    void clear(float* pixel) const override {
        std::fill_n(pixel, floats_per_pixel(), 0.0F);
        for (std::uint32_t i = 0; i < k(); ++i) pixel[i * floats + slot] = sentinel_depth;
        const IsosurfaceState none;
        float* state = pixel + k() * floats;
        state[0] = empty_depth;
        state[1] = none.iso;
    }

    bool insert(float* pixel, const float* fragment) const override {
        const Sort::Entry first = Sort::push_pop(pixel, k(), fragment);
        look_between(first.data(), pixel, pixel + k() * floats);
        return true;
    }

    void make_entry(const pipeline::Fragment& fragment, float* entry) const override {
        entry[0] = finite(depth_.distance(fragment.depth));
        entry[1] = finite(fragment.rgba[0]);
    }

    bool drains() const override { return true; }
    void drain(float* pixel) const override {
        float* state = pixel + k() * floats;
        for (std::uint32_t i = 0; i + 1 < k(); ++i) look_between(pixel + i * floats, pixel + (i + 1) * floats, state);
        for (std::uint32_t i = 0; i < k(); ++i) {
            pixel[i * floats] = sentinel_depth;
            pixel[i * floats + 1] = 0.0F;
        }
    }

  private:
    // Both sides of a crossing lie on different sides of the value, so s1 != s2 and the division is defined.
    void look_between(const float* first, const float* second, float* state) const {
        if (!(std::min(first[0], second[0]) > sentinel_depth)) return;
        const double z1 = static_cast<double>(first[0]), z2 = static_cast<double>(second[0]);
        const double s1 = static_cast<double>(first[1]), s2 = static_cast<double>(second[1]);
        for (std::size_t i = 0; i < iso_.size(); ++i) {
            const double iso = static_cast<double>(iso_[i]);
            if ((s1 < iso) == (s2 < iso)) continue;
            state[2] += 1.0F;
            const double hit = z1 + (iso - s1) / (s2 - s1) * (z2 - z1);
            if (!(finite(hit) < state[0])) continue;
            state[0] = finite(hit);
            state[1] = static_cast<float>(i);
            state[3] = s2 > s1 ? 1.0F : -1.0F;
        }
    }

    std::vector<float> iso_;
    pipeline::EyeDepth depth_;
};

} // namespace

std::shared_ptr<const pipeline::ModifyProgram> make_isosurface(const IsosurfaceSetup& setup) {
    CHECK(setup.k >= 1 && setup.k <= 64);
    if (setup.iso_values.empty()) throw sim::InputError("isosurface: expected at least one iso-value, got none");
    for (const float iso : setup.iso_values)
        if (!std::isfinite(iso))
            throw sim::InputError(fmt::format("isosurface: expected finite iso-values, got {}", iso));
    return std::make_shared<const Isosurface>(setup);
}

IsosurfaceState isosurface_state(const pipeline::ModifyProgram& program, const float* pixel) {
    const float* state = pixel + std::size_t{program.k()} * program.floats_per_entry();
    return {state[0], state[1], state[2], state[3]};
}

} // namespace models
