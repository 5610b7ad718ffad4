#include "models/programs/depth_partition.hpp"

#include "models/programs/nearest_k.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace models {

namespace {

class DepthPartition final : public pipeline::ModifyProgram {
  public:
    explicit DepthPartition(std::vector<float> bounds)
        : ModifyProgram(static_cast<std::uint32_t>(bounds.size()) - 1, floats), bounds_(std::move(bounds)) {}

    std::string_view id() const override { return "depth-partition"; }
    std::string_view summary() const override { return "the nearest fragment of each range of depths (A14)"; }
    /// A compare with each bound, one with the entry, and the moves of a fragment.
    pipeline::ProgramCost cost() const override { return {k() + 1 + 1 + floats}; }
    pipeline::OrderNeed order_need() const override { return pipeline::OrderNeed::any; }
    bool needs_texture() const override { return false; }
    bool needs_colour() const override { return true; }
    std::uint32_t depth_slot() const override { return slot; }

    void clear(float* pixel) const override {
        std::fill_n(pixel, floats_per_pixel(), 0.0F);
        for (std::uint32_t i = 0; i < k(); ++i) pixel[i * floats + slot] = empty_depth;
    }

    bool insert(float* pixel, const float* fragment) const override {
        const float depth = fragment[slot];
        if (!(depth >= bounds_.front() && depth < bounds_.back())) return false;
        const auto above = std::upper_bound(bounds_.begin(), bounds_.end(), depth);
        float* entry = pixel + (above - bounds_.begin() - 1) * floats;
        if (!(depth < entry[slot])) return false;
        std::copy_n(fragment, floats, entry);
        return true;
    }

    void make_entry(const pipeline::Fragment& fragment, float* entry) const override {
        std::copy_n(fragment.rgba, slot, entry);
        entry[slot] = fragment.depth;
    }

    pipeline::Peeling peeling() const override { return pipeline::Peeling::ranges; }
    pipeline::DepthInterval range(std::uint32_t i) const override { return {bounds_[i], bounds_[i + 1]}; }

  private:
    static constexpr std::uint32_t floats = 4, slot = 3;

    std::vector<float> bounds_;
};

} // namespace

std::shared_ptr<const pipeline::ModifyProgram> make_depth_partition(std::vector<float> bounds) {
    if (bounds.size() < 2 || bounds.size() > 65)
        throw sim::InputError(fmt::format("depth-partition: expected 2 to 65 bounds, got {}", bounds.size()));
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        if (!std::isfinite(bounds[i]) || (i > 0 && !(bounds[i] > bounds[i - 1])))
            throw sim::InputError(fmt::format(
                "depth-partition: bound {}: expected a number greater than the one before, got {}", i, bounds[i]));
    }
    return std::make_shared<const DepthPartition>(std::move(bounds));
}

} // namespace models
