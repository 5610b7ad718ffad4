#include "models/programs/z_buffer.hpp"

#include "models/programs/nearest_k.hpp"

#include <algorithm>

namespace models {

namespace {

class ZBuffer final : public pipeline::ModifyProgram {
  public:
    ZBuffer() : ModifyProgram(1, floats) {}

    std::string_view id() const override { return "z-buffer"; }
    std::string_view summary() const override { return "the nearest fragment (k = 1)"; }
    /// A compare and the moves of a fragment.
    pipeline::ProgramCost cost() const override { return {1 + floats}; }
    pipeline::OrderNeed order_need() const override { return pipeline::OrderNeed::any; }
    bool needs_texture() const override { return false; }
    bool needs_colour() const override { return true; }
    std::uint32_t depth_slot() const override { return slot; }

    void clear(float* pixel) const override {
        std::fill_n(pixel, slot, 0.0F);
        pixel[slot] = empty_depth;
    }
    bool insert(float* pixel, const float* fragment) const override {
        if (!(fragment[slot] < pixel[slot])) return false;
        std::copy_n(fragment, floats, pixel);
        return true;
    }
    void make_entry(const pipeline::Fragment& fragment, float* entry) const override {
        std::copy_n(fragment.rgba, slot, entry);
        entry[slot] = fragment.depth;
    }
    pipeline::Peeling peeling() const override { return pipeline::Peeling::nearest; }

  private:
    static constexpr std::uint32_t floats = 4, slot = 3;
};

} // namespace

std::shared_ptr<const pipeline::ModifyProgram> make_z_buffer() { return std::make_shared<const ZBuffer>(); }

} // namespace models
