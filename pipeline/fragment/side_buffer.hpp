// The side buffer of the fragment scheduler: quads that wait for their area.
//
// Modelled as hardware that finds in one cycle the oldest quads that may go: per key a list in order of age, and the
// heads of lists that are free in order of age. Its work per quad does not depend on how many wait.
// Source: specification 004, section 7.2 (steps 3-5).
#pragma once

#include "pipeline/fragment/messages.hpp"
#include "sim/check.hpp"

#include <cstdint>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

namespace pipeline {

class SideBuffer {
  public:
    struct Waiting {
        QuadTask task;
        std::uint32_t key = 0;
        sim::Cycle since = 0; ///< when it came
    };

    /// @param keys of the guard, see DispatchGuard::keys
    /// @param order_rule quads of one key leave in order of age. Else quads of one key with the same pixels do, since
    ///        whatever frees one of them frees the older one, too.
    SideBuffer(std::uint32_t keys, bool order_rule)
        : lanes_(order_rule ? 1 : pixel_masks), lists_(std::size_t{keys} * lanes_) {}

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    /// A quad of the key waits; with the order rule only.
    bool waits(std::uint32_t key) const { return lists_[std::size_t{key} * lanes_].first != none; }

    void insert(const Waiting& waiting);
    /// A quad of the key was released, or left this buffer: those that `free(const Waiting&)` calls free may go.
    template <class Free>
    void offer(std::uint32_t key, Free&& free);
    /// The oldest quad that may go, or null. Without the order rule `free` may have changed since it was offered.
    template <class Free>
    const Waiting* oldest(Free&& free);
    /// Takes out what oldest() gave; the next quad of its list is to be offered by the caller.
    Waiting take_oldest();

  private:
    static constexpr std::uint32_t none = 0; ///< places are numbered from 1
    static constexpr std::uint32_t pixel_masks = 16;
    struct Place {
        Waiting waiting;
        std::uint64_t age = 0; ///< insertions before it
        std::uint32_t next = none;
        bool offered = false; ///< in `free_`
    };
    struct List {
        std::uint32_t first = none, last = none;
    };
    using Aged = std::pair<std::uint64_t, std::uint32_t>; ///< age, place

    Place& at(std::uint32_t place) { return places_[place - 1]; }
    List& list_of(const Waiting& waiting) {
        return lists_[std::size_t{waiting.key} * lanes_ + (lanes_ == 1 ? 0 : waiting.task.pixels())];
    }

    std::uint32_t lanes_; ///< lists of a key
    std::vector<List> lists_;
    std::vector<Place> places_; ///< as many as have ever been taken at once
    std::vector<std::uint32_t> unused_;
    std::priority_queue<Aged, std::vector<Aged>, std::greater<>> free_;
    std::uint64_t insertions_ = 0;
    std::size_t size_ = 0;
};

inline void SideBuffer::insert(const Waiting& waiting) {
    if (unused_.empty()) {
        places_.emplace_back();
        unused_.push_back(static_cast<std::uint32_t>(places_.size()));
    }
    const std::uint32_t place = unused_.back();
    unused_.pop_back();
    at(place) = {waiting, insertions_++};
    List& list = list_of(waiting);
    (list.first == none ? list.first : at(list.last).next) = place;
    list.last = place;
    ++size_;
}

template <class Free>
void SideBuffer::offer(std::uint32_t key, Free&& free) {
    if (empty()) return;
    for (std::uint32_t lane = 0; lane < lanes_; ++lane) {
        const std::uint32_t first = lists_[std::size_t{key} * lanes_ + lane].first;
        if (first == none || at(first).offered || !free(std::as_const(at(first).waiting))) continue;
        at(first).offered = true;
        free_.emplace(at(first).age, first);
    }
}

template <class Free>
const SideBuffer::Waiting* SideBuffer::oldest(Free&& free) {
    for (; !free_.empty(); free_.pop()) {
        Place& place = at(free_.top().second);
        if (free(std::as_const(place.waiting))) return &place.waiting;
        place.offered = false;
    }
    return nullptr;
}

inline SideBuffer::Waiting SideBuffer::take_oldest() {
    const std::uint32_t place = free_.top().second;
    free_.pop();
    const Waiting waiting = at(place).waiting;
    List& list = list_of(waiting);
    CHECK(list.first == place);
    list.first = at(place).next;
    if (list.first == none) list.last = none;
    unused_.push_back(place);
    --size_;
    return waiting;
}

} // namespace pipeline
