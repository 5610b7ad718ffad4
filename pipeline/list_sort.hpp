// The full-screen pass that puts the fragments of each pixel's list into its entries: what its shader loads, stores and
// executes.
//
// Modelled: the walk along the list, each node found through the one before; the array that holds the fragments, in
// local memory, past every cache, or its first places in registers; an insertion sort, whose steps are those that the
// depths at hand need; lanes in lockstep: a quad runs as long as the longest of its four lists, and each row of its
// sort as long as the longest of four.
// Not modelled: caches of local memory (GPUs before 2010 have none); other sorts for long lists; shaders compiled per
// length of list within one pass.
// Source: Yang, Hensley, Gruen, Thibieroz, "Real-Time Concurrent Linked List Construction on the GPU", EGSR 2010
// (lists, insertion sort in the shader); Knowles, Leach, Zambetta, "Fast sorting for exact OIT of complex scenes", The
// Visual Computer 2014 (registers against local memory); specification 004, section 8.
#pragma once

#include "pipeline/output/fragment_lists.hpp"
#include "pipeline/output/kbuffer_design.hpp"
#include "pipeline/screen_pass.hpp"

#include <array>
#include <string>
#include <vector>

namespace pipeline {

/// What one quad of the pass does; instructions are those of the listing in list_sort.cpp.
struct ListSortWork {
    std::uint32_t longest = 0; ///< nodes of its longest list
    std::uint32_t instructions = 0;
    std::uint32_t local_loads = 0, local_stores = 0; ///< of four lanes each
};

/// The work of a quad whose lists have these depths, in order of arrival. Equal depths keep that order.
/// @param depths of the four pixels
ListSortWork list_sort_work(const ListsSite& site, const ModifyProgram& program,
                            const std::array<std::vector<float>, 4>& depths);

/// The pass over all pixels of the k-buffer, whose fragments are in `lists`. All must outlive it.
/// @param heads address of the lists' heads
ScreenPass list_sort_pass(const std::string& name, const ListsSite& site, const ModifyProgram& program,
                          const FragmentLists& lists, std::uint64_t heads, const FragmentStream& stream);

} // namespace pipeline
