#include "models/programs/two_class.hpp"

#include <algorithm>

namespace models {

namespace {

class TwoClass final : public pipeline::ModifyProgram {
  public:
    TwoClass() : ModifyProgram(2, two_class_floats) {}

    std::string_view id() const override { return "two-class"; }
    std::string_view summary() const override {
        return "the nearest opaque fragment, and the nearest transparent one in front of it";
    }
    /// The class of the fragment; compares with both depths; the moves of a fragment, and those that empty an entry.
    pipeline::ProgramCost cost() const override { return {2 + 2 + 2 * two_class_floats}; }
    pipeline::OrderNeed order_need() const override { return pipeline::OrderNeed::any; }
    bool needs_texture() const override { return false; }
    bool needs_colour() const override { return true; }
    bool entries_are_colours() const override { return false; }
    bool entries_are_sorted() const override { return false; }
    std::uint32_t depth_slot() const override { return slot; }

    void clear(float* pixel) const override {
        empty(pixel);
        empty(pixel + two_class_floats);
    }
    bool insert(float* pixel, const float* fragment) const override {
        float* const transparent = pixel + std::size_t{transparent_entry} * two_class_floats;
        float* const opaque = pixel + std::size_t{opaque_entry} * two_class_floats;
        const float depth = fragment[slot];
        if (!(depth < opaque[slot])) return false;
        if (TwoClassWords::is_opaque(fragment)) {
            std::copy_n(fragment, two_class_floats, opaque);
            if (transparent[slot] >= depth) empty(transparent);
            return true;
        }
        if (!(depth < transparent[slot])) return false;
        std::copy_n(fragment, two_class_floats, transparent);
        return true;
    }
    void make_entry(const pipeline::Fragment& fragment, float* entry) const override {
        std::copy_n(fragment.rgba, slot, entry);
        entry[slot] = fragment.depth;
    }

  private:
    static constexpr std::uint32_t slot = 3;

    static void empty(float* entry) {
        std::fill_n(entry, slot, 0.0F);
        entry[TwoClassWords::class_word] = TwoClassWords::packed(TwoClassWords::opaque << TwoClassWords::opacity_shift);
        entry[slot] = 1.0F;
    }
};

} // namespace

std::shared_ptr<const pipeline::ModifyProgram> make_two_class() { return std::make_shared<const TwoClass>(); }

} // namespace models
