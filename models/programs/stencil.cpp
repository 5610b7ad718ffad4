#include "models/programs/stencil.hpp"

#include "models/programs/nearest_k.hpp"
#include "sim/check.hpp"

#include <algorithm>

namespace models {

namespace {

class Stencil final : public pipeline::ModifyProgram {
  public:
    explicit Stencil(const StencilSetup& setup) : ModifyProgram(1, floats), setup_(setup) {}

    std::string_view id() const override { return "stencil"; }
    std::string_view summary() const override { return "counts the fragments that pass a compare (k = 1)"; }
    /// The compare, the step and its limit, and two moves.
    pipeline::ProgramCost cost() const override { return {1 + 2 + 2}; }
    pipeline::OrderNeed order_need() const override { return pipeline::OrderNeed::primitive_order; }
    bool needs_texture() const override { return false; }
    bool needs_colour() const override { return false; }
    std::uint32_t depth_slot() const override { return 0; }

    void clear(float* pixel) const override {
        std::fill_n(pixel, floats_per_pixel(), 0.0F);
        pixel[0] = empty_depth;
    }
    bool insert(float* pixel, const float* fragment) const override {
        const bool pass = passes(pixel[1]);
        const float value = after(pass ? setup_.pass : setup_.fail, pixel[1]);
        const float depth = pass ? fragment[0] : pixel[0];
        const bool changed = value != pixel[1] || depth != pixel[0];
        pixel[0] = depth;
        pixel[1] = value;
        return changed;
    }
    void make_entry(const pipeline::Fragment& fragment, float* entry) const override {
        entry[0] = fragment.depth;
        entry[1] = 0.0F;
    }

  private:
    static constexpr std::uint32_t floats = 2;

    bool passes(float stored) const {
        const auto reference = static_cast<float>(setup_.reference);
        switch (setup_.compare) {
        case StencilCompare::always:
            return true;
        case StencilCompare::never:
            return false;
        case StencilCompare::less:
            return reference < stored;
        case StencilCompare::less_or_equal:
            return reference <= stored;
        case StencilCompare::equal:
            return reference == stored;
        case StencilCompare::not_equal:
            return reference != stored;
        case StencilCompare::greater:
            return reference > stored;
        }
        CHECK(false);
    }

    float after(StencilOperation operation, float stored) const {
        switch (operation) {
        case StencilOperation::keep:
            return stored;
        case StencilOperation::zero:
            return 0.0F;
        case StencilOperation::replace:
            return static_cast<float>(setup_.reference);
        case StencilOperation::increment:
            return std::min(stored + 1.0F, 255.0F);
        case StencilOperation::decrement:
            return std::max(stored - 1.0F, 0.0F);
        }
        CHECK(false);
    }

    StencilSetup setup_;
};

} // namespace

std::shared_ptr<const pipeline::ModifyProgram> make_stencil(const StencilSetup& setup) {
    return std::make_shared<const Stencil>(setup);
}

} // namespace models
