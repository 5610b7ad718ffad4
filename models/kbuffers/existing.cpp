// D0: the k-buffer on existing hardware. The shader reads its pixel as a texture, modifies it, and stores all entries
// through the reorder buffer; nothing protects the interval in between.
//
// Source: specification 004, section 7.1; Bavoil 2007, sections 4.3.1 and 4.3.2.
#include "models/kbuffers/unprotected.hpp"

namespace models {

namespace {

using namespace pipeline;

struct ExistingParams {
    Visibility visibility = Visibility::writeback;
    TextureCoherence tex_coherence = TextureCoherence::invalidate_on_draw;
    bool bypass_l1 = false;
    bool atomic_reads = false;
    std::uint32_t flush_triangles = 0;
    bool flush_draws = false;
    bool drain = true;
    bool writeback = true;
    bool invalidate = true;

    static constexpr auto fields() {
        using P = ExistingParams;
        return std::tuple_cat(
            visibility_fields<P>(),
            std::tuple{sim::field<&P::bypass_l1>("k-buffer reads do not look into the texture caches"),
                       sim::field<&P::atomic_reads>(
                           "One read returns all render targets of a pixel at one instant (no torn reads, H4)"),
                       sim::field<&P::flush_triangles>("Flush after this many triangles; 0 = never").unit("triangles"),
                       sim::field<&P::flush_draws>("Flush at every draw boundary")},
            flush_fields<P>());
    }
};
static_assert(sim::fully_described<ExistingParams>);

class Existing final : public ConfiguredDesign<Existing, ExistingParams> {
  public:
    static constexpr std::string_view name = "existing";
    static constexpr std::string_view text = "D0: shader reads and writes the k-buffer as textures, unprotected";

    using ConfiguredDesign::ConfiguredDesign;

    KBufferPlan plan(const ModifyProgram&, const View&) const override {
        KBufferPlan plan = unprotected(params_);
        plan.shader.bypass_l1 = params_.bypass_l1;
        plan.shader.atomic_reads = params_.atomic_reads;
        plan.shader.flush = {params_.flush_triangles, params_.flush_draws, params_.drain, params_.writeback,
                             params_.invalidate};
        return plan;
    }
};

} // namespace

DesignInfo existing_design() { return Existing::info(); }

} // namespace models
