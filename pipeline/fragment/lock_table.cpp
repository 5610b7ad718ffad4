#include "pipeline/fragment/lock_table.hpp"

#include <utility>

namespace pipeline {

LockTable::LockTable(sim::Context context, const ShaderSite& site, const PassContext& pass, std::uint32_t pipes,
                     std::uint32_t partitions, std::uint32_t quads)
    : Component(std::move(context)),
      site_(&site),
      pass_(&pass),
      first_(site.lock_area == LockArea::tile ? pass.layout.tiles() : pass.layout.blocks(), nobody),
      waiting_(quads),
      granted_(quads) {
    for (std::uint32_t at = quads; at > 0; --at) free_.push_back(at - 1);
    port_names_.reserve(std::size_t{2} * pipes + partitions);
    for (std::uint32_t pipe = 0; pipe < pipes; ++pipe) {
        requests_in.emplace_back(*this, port_names_.emplace_back("requests" + std::to_string(pipe) + "_in"));
        grants_out.emplace_back(*this, port_names_.emplace_back("grants" + std::to_string(pipe) + "_out"));
    }
    for (std::uint32_t rop = 0; rop < partitions; ++rop)
        releases_in.emplace_back(*this, port_names_.emplace_back("releases" + std::to_string(rop) + "_in"));
    begin_pass();
}

void LockTable::begin_pass() {
    CHECK_MSG(free_.size() == waiting_.size(), "a quad still waits for its critical section");
    locks_.assign(first_.size() * (site_->lock_area == LockArea::pixel ? 4 : 1), 0);
}

std::uint32_t LockTable::area_of(QuadId quad) const {
    const Quad& place = pass_->stream->quads[quad];
    return site_->lock_area == LockArea::tile ? pass_->layout.tile_of(place.x, place.y)
                                              : pass_->layout.block_of(place.x, place.y);
}

template <class Visit>
void LockTable::for_each_lock(const LockRequest& request, Visit&& visit) const {
    const std::uint32_t area = area_of(request.quad);
    if (site_->lock_area != LockArea::pixel) {
        visit(area, request.ticket);
        return;
    }
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel)
        if ((request.mask >> pixel & 1) != 0) visit(area * 4 + pixel, request.order[pixel]);
}

// All locks of the quad or none, so that two quads cannot hold what the other waits for.
bool LockTable::try_enter(const LockRequest& request) {
    bool open = true;
    for_each_lock(request, [&](std::uint32_t lock, std::uint32_t ticket) {
        open = open && locks_[lock] == (ordered() ? ticket : 0);
    });
    if (open && !ordered()) for_each_lock(request, [&](std::uint32_t lock, std::uint32_t) { locks_[lock] = 1; });
    return open;
}

void LockTable::grant(const Waiting& waiting) {
    granted_.push(std::uint32_t{waiting.pipe} << 16U | waiting.request.thread);
    stats_.wait.note(cycle() - waiting.since);
}

void LockTable::release(const Commit& commit) {
    LockRequest left;
    left.quad = commit.quad;
    left.mask = commit.mask;
    for_each_lock(left, [&](std::uint32_t lock, std::uint32_t) { locks_[lock] = ordered() ? locks_[lock] + 1 : 0; });
    ++stats_.released;
    enter_waiting(area_of(commit.quad));
}

// Lets those of an area enter that can, the longest waiting first.
void LockTable::enter_waiting(std::uint32_t area) {
    for (std::uint32_t* link = &first_[area]; *link != nobody;) {
        Waiting& waiting = waiting_[*link];
        if (!try_enter(waiting.request)) {
            link = &waiting.next;
            continue;
        }
        grant(waiting);
        free_.push_back(std::exchange(*link, waiting.next));
    }
}

bool LockTable::take_releases() {
    bool progress = false;
    for (sim::In<Commit>& port : releases_in)
        while (port.peek() != nullptr) {
            release(port.receive());
            progress = true;
        }
    return progress;
}

bool LockTable::take_requests() {
    bool progress = false;
    for (std::size_t pipe = 0; pipe < requests_in.size(); ++pipe)
        while (requests_in[pipe].peek() != nullptr) {
            const Waiting arrived{requests_in[pipe].receive(), static_cast<std::uint16_t>(pipe), cycle(), nobody};
            ++stats_.requests;
            progress = true;
            if (try_enter(arrived.request)) {
                grant(arrived);
                continue;
            }
            ++stats_.waits;
            std::uint32_t* link = &first_[area_of(arrived.request.quad)];
            while (*link != nobody) link = &waiting_[*link].next;
            *link = free_.back();
            waiting_[free_.back()] = arrived;
            free_.pop_back();
            stats_.waiting_max.note(waiting_.size() - free_.size());
        }
    return progress;
}

bool LockTable::send_grants() {
    bool progress = false;
    for (std::uint32_t n = 0; n < site_->grants_per_clk && !granted_.empty(); ++n) {
        sim::Out<LockGrant>& port = grants_out[granted_.front() >> 16U];
        if (!port.ready()) break;
        port.send({static_cast<std::uint16_t>(granted_.front() & 0xFFFFU)});
        granted_.pop();
        progress = true;
    }
    return progress;
}

sim::Activity LockTable::tick() {
    bool progress = take_releases();
    progress |= take_requests();
    progress |= send_grants();
    if (!granted_.empty()) wake_in(1);
    if (progress) return sim::Activity::busy;
    return free_.size() == waiting_.size() ? sim::Activity::starved : sim::Activity::hazard;
}

} // namespace pipeline
