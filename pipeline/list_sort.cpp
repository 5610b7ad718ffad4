#include "pipeline/list_sort.hpp"

#include <algorithm>
#include <array>

namespace pipeline {

namespace {

// The shader, in vector instructions that four lanes execute together. n is the longest of the quad's lists, m the
// registers of one entry. Registers cannot be indexed: where the array lies in them, the rows of the sort are unrolled;
// in local memory they are a loop.
//
//     head:   ld      link, heads[pixel]               1
//             mov     count, 0                         1
//     node:   setp.ne live, link, end                  1
//             bra     done, no lane is live            1
//             mad     at, link, node bytes, pool       1
//             ld      e, link, [at]                    one for each 16 bytes of the node
//     full sort, row of node i:
//       for each place j = i-1, i-2 ... until no lane goes on:
//             [add    at, at, -stride                  1, in local memory only]
//             [ld     a, [at]                          m, in local memory only]
//             setp.gt p, a[j].depth, e.depth           1
//       @!p   mov     a[j+1], e                        m (st, in local memory)
//       @p    mov     a[j+1], a[j]                     m (st, in local memory: both lanes' in one access)
//             bra     next, p in no lane               1
//       lanes at the front:
//             mov     a[0], e                          m (st, in local memory)
//     or the entries only:
//             the modify program on e                  its operations, four in an instruction
//             add     count, count, 1                  1
//             bra     node                             1
//     done:   behind a full sort, a[0] ... a[k-1] where the entries are the nearest ones, else all:
//             [add    at, at, stride                   1, in local memory only]
//             [ld     e, [at]                          m, in local memory only]
//             the modify program on e                  as above; not where they are the entries
//             mov     out[t], entry                    one for each render target
constexpr std::uint32_t head_instructions = 2;
constexpr std::uint32_t node_instructions = 5; ///< but for its loads
constexpr std::uint32_t step_instructions = 2; ///< but for its moves
constexpr std::uint32_t load_bytes = 16;

/// Registers that the shader needs beside the array: the element in hand and a second one on its way to or from local
/// memory, link, address, count, comparison, position and the surfaces' addresses.
constexpr std::uint32_t own_registers = 8;

constexpr std::uint32_t groups_of(std::uint32_t value, std::uint32_t by) { return (value + by - 1) / by; }

std::uint32_t moves_of_entry(const ModifyProgram& program) { return groups_of(program.floats_per_entry(), 4); }

std::uint32_t program_instructions(const ModifyProgram& program) { return groups_of(program.cost().operations, 4); }

/// Places of the array that are in registers. Registers have four floats; small entries share one.
std::uint32_t places_in_registers(const ListsSite& site, const ModifyProgram& program) {
    return site.array_registers * 4 / program.floats_per_entry();
}

std::uint32_t registers_for(const ListsSite& site, const ModifyProgram& program, std::uint32_t longest) {
    if (site.sort == ListSort::entries) return own_registers + program.targets();
    const std::uint32_t kept = std::min(longest, places_in_registers(site, program));
    return own_registers + groups_of(kept * program.floats_per_entry(), 4);
}

constexpr std::uint64_t segment_line = 64; ///< of a request of the texture unit
constexpr std::uint64_t burst_bytes = 32;  ///< of a burst: uncached loads fetch no more than they need
constexpr std::uint64_t spill_address = std::uint64_t{3} << 41U;
constexpr std::uint64_t samples_address = std::uint64_t{5} << 40U; ///< of lists that are arrays

// Adds what an access of one lane needs, joined with what another lane of the step asks for in the same line.
void add_access(std::vector<MemorySegment>& segments, std::uint64_t address, std::uint64_t bytes, bool write) {
    const std::uint64_t end = (address + bytes + burst_bytes - 1) / burst_bytes * burst_bytes;
    for (std::uint64_t from = address / burst_bytes * burst_bytes; from < end;) {
        const std::uint64_t line = from / segment_line, to = std::min(end, (line + 1) * segment_line);
        const auto same = std::find_if(segments.begin(), segments.end(), [&](const MemorySegment& segment) {
            return segment.address / segment_line == line && segment.write == write;
        });
        if (same == segments.end()) {
            segments.push_back({from, static_cast<std::uint32_t>(to - from), write});
        } else {
            const std::uint64_t first = std::min(same->address, from), last = std::max(same->address + same->bytes, to);
            *same = {first, static_cast<std::uint32_t>(last - first), write};
        }
        from = to;
    }
}

class ListSortShader final : public ScreenShader {
  public:
    ListSortShader(const ListsSite& site, const ModifyProgram& program, const FragmentLists& lists, std::uint64_t heads,
                   const FragmentStream& stream)
        : site_(site), program_(&program), lists_(&lists), heads_(heads), work_(lists.layout().blocks()) {
        std::array<std::vector<float>, 4> depths;
        for (std::uint32_t block = 0; block < work_.size(); ++block) {
            for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
                depths[pixel].clear();
                for (const FragmentLists::Node& node : lists.fragments(block, pixel))
                    depths[pixel].push_back(stream.depths[node.quad][pixel]);
            }
            work_[block] = list_sort_work(site, program, depths);
            longest_ = std::max(longest_, work_[block].longest);
        }
    }

    std::uint32_t longest() const { return longest_; }

    std::uint32_t alu(std::uint32_t x, std::uint32_t y) const override { return work(x, y).instructions; }
    // The heads lie block by block.
    std::uint32_t fetches(std::uint32_t x, std::uint32_t y) const override {
        const std::uint64_t first = heads(x, y);
        return static_cast<std::uint32_t>((first + std::uint64_t{4} * site_.head_bytes - 1) / segment_line -
                                          first / segment_line) +
               1;
    }
    std::uint64_t line(std::uint32_t x, std::uint32_t y, std::uint32_t fetch) const override {
        return heads(x, y) / segment_line + fetch;
    }

    // One step for each node, and one for each place of the array in local memory that is looked at. The nodes of
    // lists that are arrays are known from the head: all are loaded in one step.
    std::uint32_t steps(std::uint32_t x, std::uint32_t y) const override {
        const ListSortWork& quad = work(x, y);
        if (quad.longest == 0) return 0;
        return (site_.chained ? quad.longest : 1) + std::max(quad.local_loads, quad.local_stores);
    }
    void step(std::uint32_t x, std::uint32_t y, std::uint32_t number,
              std::vector<MemorySegment>& segments) const override {
        const ListSortWork& quad = work(x, y);
        const std::uint32_t loads = site_.chained ? quad.longest : 1;
        const std::uint32_t block = lists_->layout().block_of(x, y);
        if (number >= loads) {
            local_step(block, number - loads, quad, segments);
        } else if (site_.chained) {
            load_nodes(x, y, number, segments);
        } else {
            const std::uint64_t bytes = std::uint64_t{4} * site_.fragment_bytes;
            const std::uint64_t samples = std::uint64_t{site_.per_pixel} * site_.passes;
            add_access(segments, samples_address + block * samples * bytes, quad.longest * bytes, false);
        }
    }

  private:
    const ListSortWork& work(std::uint32_t x, std::uint32_t y) const { return work_[lists_->layout().block_of(x, y)]; }
    std::uint64_t heads(std::uint32_t x, std::uint32_t y) const {
        return heads_ + std::uint64_t{lists_->layout().block_of(x, y)} * 4 * site_.head_bytes;
    }

    // The newest node of a list hangs at its head.
    void load_nodes(std::uint32_t x, std::uint32_t y, std::uint32_t number,
                    std::vector<MemorySegment>& segments) const {
        const SurfaceLayout& layout = lists_->layout();
        for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
            const auto& nodes = lists_->fragments(layout.block_of(x, y), pixel);
            if (number >= nodes.size()) continue;
            const std::uint64_t byte = std::uint64_t{nodes[nodes.size() - 1 - number].number} * site_.fragment_bytes;
            add_access(segments, FragmentLists::address(layout.partition_of(x, y), layout.partitions, byte),
                       site_.fragment_bytes, false);
        }
    }

    // The array's places behind the registers, four lanes side by side; which of them a step looks at matters to the
    // rows of the memory only.
    void local_step(std::uint32_t block, std::uint32_t number, const ListSortWork& quad,
                    std::vector<MemorySegment>& segments) const {
        const std::uint64_t bytes = 16 * std::uint64_t{program_->floats_per_entry()};
        const std::uint64_t behind = longest_ - std::min(longest_, places_in_registers(site_, *program_));
        const std::uint64_t place = std::uint64_t{block} * behind + number % std::max<std::uint64_t>(behind, 1);
        if (number < quad.local_loads) add_access(segments, spill_address + place * bytes, bytes, false);
        if (number < quad.local_stores) add_access(segments, spill_address + place * bytes, bytes, true);
    }

    ListsSite site_;
    const ModifyProgram* program_;
    const FragmentLists* lists_;
    std::uint64_t heads_;            ///< address
    std::vector<ListSortWork> work_; ///< by 2x2 block
    std::uint32_t longest_ = 0;
};

/// A row of the sort.
struct Row {
    std::uint32_t looks = 0; ///< places that the shader looks at
    bool front = false;      ///< the element went before all others
};

/// A pixel's array on its way to being sorted.
class SortedDepths {
  public:
    /// Puts a depth in, before or behind those equal to it.
    Row insert(float depth, bool before_equal) {
        const auto at = before_equal ? std::lower_bound(depths_.begin(), depths_.end(), depth)
                                     : std::upper_bound(depths_.begin(), depths_.end(), depth);
        const auto moved = static_cast<std::uint32_t>(depths_.end() - at);
        const bool front = at == depths_.begin();
        depths_.insert(at, depth);
        return {front ? moved : moved + 1, front};
    }

  private:
    std::vector<float> depths_;
};

/// Adds the rows of the sort.
void add_rows(ListSortWork& work, const ListsSite& site, const ModifyProgram& program,
              const std::array<std::vector<float>, 4>& depths) {
    const std::uint32_t moves = moves_of_entry(program), in_registers = places_in_registers(site, program);
    std::array<SortedDepths, 4> arrays;
    for (std::uint32_t i = 0; i < work.longest; ++i) {
        Row row;
        for (std::uint32_t lane = 0; lane < 4; ++lane) {
            const auto& list = depths[lane];
            if (i >= list.size()) continue;
            const Row own = arrays[lane].insert(list[site.chained ? list.size() - 1 - i : i], site.chained);
            row = {std::max(row.looks, own.looks), row.front || own.front};
        }
        const std::uint32_t loads = i > in_registers ? std::min(row.looks, i - in_registers) : 0;
        work.instructions += row.looks * (step_instructions + 2 * moves) + loads * (1 + moves) + moves;
        work.local_loads += loads;
        // Each look writes the place behind the one looked at.
        if (i >= in_registers) work.local_stores += std::min(row.looks, i + 1 - in_registers);
        if (in_registers == 0 && row.front) ++work.local_stores;
    }
}

} // namespace

// Where a list is a chain its newest node comes first, and older ones go before those of their depth.
ListSortWork list_sort_work(const ListsSite& site, const ModifyProgram& program,
                            const std::array<std::vector<float>, 4>& depths) {
    ListSortWork work;
    for (const auto& list : depths) work.longest = std::max(work.longest, static_cast<std::uint32_t>(list.size()));
    const std::uint32_t loads = groups_of(site.fragment_bytes, load_bytes);
    work.instructions = head_instructions + work.longest * (node_instructions + loads) + program.targets();
    if (site.sort == ListSort::entries) {
        work.instructions += work.longest * program_instructions(program);
        return work;
    }
    add_rows(work, site, program, depths);
    const bool nearest = program.peeling() == Peeling::nearest;
    const std::uint32_t read = nearest ? std::min(work.longest, program.k()) : work.longest;
    const std::uint32_t from_memory = read - std::min(read, places_in_registers(site, program));
    work.local_loads += from_memory;
    work.instructions += from_memory * (1 + moves_of_entry(program));
    if (!nearest) work.instructions += read * program_instructions(program);
    return work;
}

ScreenPass list_sort_pass(const std::string& name, const ListsSite& site, const ModifyProgram& program,
                          const FragmentLists& lists, std::uint64_t heads, const FragmentStream& stream) {
    auto shader = std::make_shared<const ListSortShader>(site, program, lists, heads, stream);
    ScreenPass pass;
    pass.name = name;
    pass.width = lists.layout().width;
    pass.height = lists.layout().rows();
    pass.written_bytes = program.bytes_per_pixel();
    pass.registers = registers_for(site, program, shader->longest());
    pass.shader = std::move(shader);
    return pass;
}

} // namespace pipeline
