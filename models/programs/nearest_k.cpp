#include "models/programs/nearest_k.hpp"

#include "models/programs/insertion.hpp"
#include "sim/check.hpp"

#include <algorithm>

namespace models {

namespace {

// The layout of an entry is a template parameter because insert() runs once per fragment of every run.
template <EntryKind kind>
class NearestK final : public pipeline::ModifyProgram {
  public:
    explicit NearestK(std::uint32_t k) : ModifyProgram(k, floats) {}

    std::string_view id() const override { return "nearest-k"; }
    std::string_view summary() const override {
        return kind == EntryKind::z ? "the k smallest depths, sorted (A6)"
               : has_object         ? "the k nearest fragments with their objects, sorted (A6)"
                                    : "the k nearest fragments with their colours, sorted (A6)";
    }
    pipeline::ProgramCost cost() const override { return {Pass::operations(k())}; }
    pipeline::OrderNeed order_need() const override { return pipeline::OrderNeed::any; }
    bool needs_texture() const override { return false; }
    bool needs_colour() const override { return kind == EntryKind::rgbz || kind == EntryKind::zor; }
    std::uint32_t depth_slot() const override { return slot; }

    void clear(float* pixel) const override {
        std::fill_n(pixel, floats_per_pixel(), 0.0F);
        for (std::uint32_t i = 0; i < k(); ++i) pixel[i * floats + slot] = empty_depth;
    }

    bool insert(float* pixel, const float* fragment) const override {
        typename Pass::Entry left;
        std::copy_n(fragment, floats, left.begin());
        return Pass::exchange(pixel, k(), left);
    }

    void make_entry(const pipeline::Fragment& fragment, float* entry) const override {
        entry[slot] = fragment.depth;
        if constexpr (kind == EntryKind::rgbz) std::copy_n(fragment.rgba, 3, entry);
        if constexpr (has_object) entry[1] = static_cast<float>(fragment.draw);
        if constexpr (kind == EntryKind::zor) entry[2] = fragment.rgba[0];
    }
    pipeline::Peeling peeling() const override { return pipeline::Peeling::nearest; }

  private:
    static constexpr bool has_object = kind == EntryKind::zo || kind == EntryKind::zor;
    static constexpr std::uint32_t floats = std::array{4U, 1U, 2U, 3U}[static_cast<std::size_t>(kind)];
    static constexpr std::uint32_t slot = kind == EntryKind::rgbz ? 3 : 0;
    using Pass = Insertion<floats, slot>;
};

} // namespace

std::shared_ptr<const pipeline::ModifyProgram> make_nearest_k(EntryKind entry, std::uint32_t k) {
    CHECK(k >= 1 && k <= 64);
    if (entry == EntryKind::z) return std::make_shared<const NearestK<EntryKind::z>>(k);
    if (entry == EntryKind::zor) return std::make_shared<const NearestK<EntryKind::zor>>(k);
    if (entry == EntryKind::zo) return std::make_shared<const NearestK<EntryKind::zo>>(k);
    return std::make_shared<const NearestK<EntryKind::rgbz>>(k);
}

} // namespace models
