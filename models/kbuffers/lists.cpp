// Designs that keep every fragment and sort later: linked lists in memory (the A-buffer of 2010), and the samples of a
// multisampled target into which the stencil test routes one fragment after the other (2007).
//
// Neither reads, modifies and writes an entry while fragments fly, so neither has hazards. Lists lose fragments when
// their memory is full, samples when a pixel gets more fragments than there are samples in all passes. Source:
// specification 004, section 8.
#include "models/kbuffers/configured_design.hpp"

namespace models {

namespace {

using namespace pipeline;

struct LinkedListParams {
    std::uint64_t nodes = 0;
    std::uint32_t node_bytes = 32;
    std::uint32_t counter_per_clk = 64;

    static constexpr auto fields() {
        using P = LinkedListParams;
        return std::tuple{
            sim::field<&P::nodes>("Fragments that fit into the lists' memory; 0 = any number").unit("fragments"),
            sim::field<&P::node_bytes>("A fragment with its link").unit("bytes").range(8, 256),
            sim::field<&P::counter_per_clk>("Fragments per cycle that the counter of the memory serves")
                .unit("fragments")
                .range(1, 4096)};
    }
};
static_assert(sim::fully_described<LinkedListParams>);

class LinkedList final : public ConfiguredDesign<LinkedList, LinkedListParams> {
  public:
    static constexpr std::string_view name = "linked-list";
    static constexpr std::string_view text = "lists of all fragments in memory, sorted by a later pass";

    using ConfiguredDesign::ConfiguredDesign;

    KBufferPlan plan(const ModifyProgram&, const View&) const override {
        KBufferPlan plan;
        plan.site = UpdateSite::lists;
        plan.lists.pool = params_.nodes;
        plan.lists.fragment_bytes = params_.node_bytes;
        plan.lists.read_bytes = 64; // nodes of a list lie anywhere, so each costs a line
        plan.lists.counter_per_clk = params_.counter_per_clk;
        return plan;
    }
};

struct StencilRoutedParams {
    std::uint32_t samples = 8;
    std::uint32_t passes = 1;

    static constexpr auto fields() {
        using P = StencilRoutedParams;
        return std::tuple{sim::field<&P::samples>("Samples of a pixel, one fragment each").unit("samples").range(1, 32),
                          sim::field<&P::passes>("Geometry passes, each for the next fragments of every pixel")
                              .unit("passes")
                              .range(1, 64)};
    }
};
static_assert(sim::fully_described<StencilRoutedParams>);

class StencilRouted final : public ConfiguredDesign<StencilRouted, StencilRoutedParams> {
  public:
    static constexpr std::string_view name = "stencil-routed";
    static constexpr std::string_view text = "stencil test routes fragments into the samples of a pixel, sorted later";

    using ConfiguredDesign::ConfiguredDesign;

    KBufferPlan plan(const ModifyProgram& program, const View&) const override {
        KBufferPlan plan;
        plan.site = UpdateSite::lists;
        plan.lists.per_pixel = params_.samples;
        plan.lists.passes = params_.passes;
        plan.lists.head_bytes = params_.samples; // a byte of stencil for each sample, all counted down
        plan.lists.fragment_bytes = plan.lists.read_bytes = 4 * program.floats_per_entry();
        return plan;
    }
};

} // namespace

DesignInfo linked_list_design() { return LinkedList::info(); }
DesignInfo stencil_routed_design() { return StencilRouted::info(); }

} // namespace models
