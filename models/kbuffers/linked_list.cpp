// Linked lists: every fragment is kept in memory, in a list of its pixel, and sorted by a later pass (A-buffer, 2010).
// A shader takes memory for its fragments with an atomic addition to one counter, and waits for the answer; the head of
// the list is exchanged in the ROP, and the node written.
// Nothing is read, modified and written while fragments fly, so there are no hazards; fragments are lost when the
// lists' memory is full.
//
// Source: specification 004, section 8.
#include "models/kbuffers/configured_design.hpp"

namespace models {

namespace {

using namespace pipeline;

struct LinkedListParams {
    std::uint64_t nodes = 0;
    std::uint32_t node_bytes = 32;
    ListCounter counter = ListCounter::quad;
    std::uint32_t counter_per_clk = 1;
    ListSort sort = ListSort::full;
    std::uint32_t array_registers = 0;

    static constexpr auto fields() {
        using P = LinkedListParams;
        return std::tuple{
            sim::field<&P::nodes>("Fragments that fit into the lists' memory; 0 = any number").unit("fragments"),
            sim::field<&P::node_bytes>("A fragment with its link").unit("bytes").range(8, 256),
            sim::field<&P::counter>("Atomics on the counter of the memory: one for the fragments of a quad, or each"),
            // One a clock at one address: NVIDIA, Kepler GK110 white paper, 2012; a ninth of that on Fermi.
            sim::field<&P::counter_per_clk>("Atomics per cycle that the counter serves, at the memory's point of "
                                            "coherence")
                .unit("atomics")
                .range(1, 4096),
            sim::field<&P::sort>("All fragments of a pixel are sorted, or put into its entries as they are found"),
            // An array that a loop indexes lies in local memory, as in the published A-buffers of 2010, since
            // registers cannot be indexed. Unrolled code that sorts in registers: Knowles, Leach, Zambetta 2014.
            sim::field<&P::array_registers>("128-bit registers that hold the first of the fragments being sorted; "
                                            "the others lie in local memory, "
                                            "past all caches")
                .unit("registers")
                .range(0, 1024)};
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
        plan.lists.counter = params_.counter;
        plan.lists.counter_per_clk = params_.counter_per_clk;
        plan.lists.sort = params_.sort;
        plan.lists.array_registers = params_.array_registers;
        return plan;
    }
};

} // namespace

DesignInfo linked_list_design() { return LinkedList::info(); }

} // namespace models
