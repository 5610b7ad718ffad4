#include "models/programs/volume.hpp"

#include "models/programs/sample_stream.hpp"
#include "sim/check.hpp"

namespace models {

namespace {

class Volume final : public SampleStream<Volume> {
  public:
    explicit Volume(const VolumeSetup& setup)
        : SampleStream(setup.k, setup.depth),
          table_(setup.transfer, setup.longest_gap, setup.table_scalars, setup.table_lengths) {}

    std::string_view id() const override { return "volume"; }
    std::string_view summary() const override { return "composites pre-integrated gaps between samples (A16)"; }
    /// The sort, a compare of the nearer with the empty entry, the length, the texture fetch (its lookup counts as
    /// one), opacity from the optical depth (a multiplication, an exponential, a difference), three multiplications for
    /// the premultiplied colour, and the composite: a difference and two operations for each of four channels.
    pipeline::ProgramCost cost() const override { return {stream_operations() + 1 + 1 + 3 + 3 + 1 + 2 * 4}; }
    bool needs_texture() const override { return true; }

    void between(const float* first, const float* second, float* state) const {
        const float length = std::max(0.0F, finite(second[0] - first[0]));
        const glm::vec4 gap = table_.gap(first[1], second[1], length);
        const float left = 1.0F - state[3];
        for (int channel = 0; channel < 4; ++channel) state[channel] = finite(state[channel] + left * gap[channel]);
    }

  private:
    PreintegratedTable table_;
};

} // namespace

std::shared_ptr<const pipeline::ModifyProgram> make_volume(const VolumeSetup& setup) {
    CHECK(setup.k >= 1 && setup.k <= 64);
    return std::make_shared<const Volume>(setup);
}

} // namespace models
