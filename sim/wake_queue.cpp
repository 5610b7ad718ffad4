#include "sim/wake_queue.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <functional>

namespace sim {

std::uint32_t WakeQueue::add_component() {
    if (component_count_ == words_ * 64) {
        std::vector<std::uint64_t> wider((words_ + 1) * reach);
        for (Cycle slot = 0; slot < reach; ++slot)
            for (std::size_t word = 0; word < words_; ++word)
                wider[slot * (words_ + 1) + word] = wheel_[slot * words_ + word];
        wheel_ = std::move(wider);
        ++words_;
    }
    far_asked_.push_back(none);
    return component_count_++;
}

void WakeQueue::wake(std::uint32_t component, Cycle at) {
    if (wake_near(component, at)) return;
    CHECK(at != none && (current_ == none || at > current_));
    if (std::exchange(far_asked_[component], at) == at) return;
    far_.push_back({at, component});
    std::push_heap(far_.begin(), far_.end(), std::greater<>());
}

Cycle WakeQueue::next_after(Cycle edge, Cycle word) const {
    // The last step looks at the word it started from again: its lower slots are the farthest edges.
    for (Cycle step = 1; step <= occupied_.size(); ++step) {
        const std::uint64_t slots = occupied_[(word + step) % occupied_.size()];
        if (slots != 0) return edge + step * 64 + static_cast<Cycle>(std::countr_zero(slots));
    }
    return none;
}

void WakeQueue::advance(Cycle edge) {
    current_ = edge;
    while (!far_.empty() && far_.front().at == edge) {
        const std::uint32_t component = far_.front().component;
        wheel_[(edge % reach) * words_ + component / 64] |= std::uint64_t{1} << (component % 64);
        std::pop_heap(far_.begin(), far_.end(), std::greater<>());
        far_.pop_back();
    }
}

} // namespace sim
