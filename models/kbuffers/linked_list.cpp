// Linked lists: every fragment is kept in memory, in a list of its pixel, and sorted by a later pass (A-buffer, 2010).
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

} // namespace

DesignInfo linked_list_design() { return LinkedList::info(); }

} // namespace models
