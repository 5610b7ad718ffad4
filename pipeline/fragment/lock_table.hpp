// The lock table: who may be inside the critical section of a fragment shader, for the part that reads, modifies and
// stores a pixel while everything before it overlaps freely.
//
// Modelled: one state per lock (a pixel, a 2x2 block or a 4x4 tile of the surface); entry in primitive order by ticket,
// or one at a time in order of arrival; grants per cycle; latency on its links. A lock is given back when the ROP has
// applied the store. Not modelled: capacity of the table, helper pixels.
// Source: specification 004, section 8 (pixel synchronisation, rasterizer-ordered views, fragment shader interlock).
#pragma once

#include "pipeline/fixed_queue.hpp"
#include "pipeline/fragment/messages.hpp"
#include "pipeline/fragment/pass_context.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"
#include "sim/stats.hpp"

#include <vector>

namespace pipeline {

struct LockTableStats {
    sim::Counter requests, waits, released;
    sim::HighWater waiting_max;
    sim::Histogram wait;

    static constexpr auto fields() {
        using S = LockTableStats;
        return std::tuple{
            sim::field<&S::requests>("Quads that asked for their critical section").unit("quads"),
            sim::field<&S::waits>("Of those, held because another quad was or had to be first").unit("quads"),
            sim::field<&S::released>("Quads that left it").unit("quads"),
            sim::field<&S::waiting_max>("Most quads held").unit("quads"),
            sim::field<&S::wait>("Time a quad was held").unit("cycles")};
    }
};
static_assert(sim::fully_described<LockTableStats>);

class LockTable final : public sim::Component {
  public:
    std::vector<sim::In<LockRequest>> requests_in; ///< one per pipe
    std::vector<sim::Out<LockGrant>> grants_out;   ///< one per pipe
    std::vector<sim::In<Commit>> releases_in;      ///< one per ROP partition

    /// @param quads most quads that can wait
    LockTable(sim::Context context, const ShaderSite& site, const PassContext& pass, std::uint32_t pipes,
              std::uint32_t partitions, std::uint32_t quads);

    const LockTableStats& stats() const { return stats_; }
    /// Tickets start again from 0; nobody may be inside.
    void begin_pass();

  private:
    static constexpr std::uint32_t nobody = ~std::uint32_t{0};

    struct Waiting {
        LockRequest request;
        std::uint16_t pipe = 0;
        sim::Cycle since = 0;
        std::uint32_t next = nobody; ///< in the chain of its area
    };

    sim::Activity tick() override;
    bool take_releases();
    bool take_requests();
    bool send_grants();
    bool try_enter(const LockRequest& request);
    void release(const Commit& commit);
    void enter_waiting(std::uint32_t area);
    void grant(const Waiting& waiting);
    bool ordered() const { return site_->critical_section == CriticalSection::ordered; }
    std::uint32_t area_of(QuadId quad) const; ///< block or tile
    /// Calls visit(lock, ticket) for each lock that these pixels of a quad take.
    template <class Visit>
    void for_each_lock(const LockRequest& request, Visit&& visit) const;

    const ShaderSite* site_;
    const PassContext* pass_;
    std::vector<std::string> port_names_;
    std::vector<std::uint32_t> locks_; ///< ordered: quads that have left; unordered: 1 while somebody is inside
    std::vector<std::uint32_t> first_; ///< longest waiting of each area
    std::vector<Waiting> waiting_;
    std::vector<std::uint32_t> free_;
    FixedQueue<std::uint32_t> granted_; ///< pipe << 16 | thread
    LockTableStats stats_;
};

} // namespace pipeline
