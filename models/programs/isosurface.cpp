#include "models/programs/isosurface.hpp"

#include "models/programs/nearest_k.hpp"
#include "models/programs/sample_stream.hpp"
#include "sim/check.hpp"

#include <cmath>
#include <fmt/format.h>

namespace models {

namespace {

class Isosurface final : public SampleStream<Isosurface> {
  public:
    explicit Isosurface(const IsosurfaceSetup& setup) : SampleStream(setup.k, setup.depth), iso_(setup.iso_values) {}

    std::string_view id() const override { return "isosurface"; }
    std::string_view summary() const override { return "the nearest crossing of iso-values along the ray (A15)"; }
    /// The sort, a compare of the nearer with the empty entry, the two differences, and for each iso-value two compares
    /// and whether they differ; a difference, a division, a multiplication and an addition for the hit; its count; the
    /// test; and three moves.
    pipeline::ProgramCost cost() const override {
        return {stream_operations() + 2 + static_cast<std::uint32_t>(iso_.size()) * (3 + 4 + 1 + 1 + 3)};
    }
    bool needs_texture() const override { return false; }

    void clear(float* pixel) const override {
        SampleStream::clear(pixel);
        state(pixel)[0] = empty_depth;
        state(pixel)[1] = IsosurfaceState{}.iso;
    }

    // Both sides of a crossing lie on different sides of the value, so s1 != s2 and the division is defined.
    void between(const float* first, const float* second, float* state) const {
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

  private:
    std::vector<float> iso_;
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
