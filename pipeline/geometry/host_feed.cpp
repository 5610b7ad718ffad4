#include "pipeline/geometry/host_feed.hpp"

#include <algorithm>
#include <cmath>

namespace pipeline {

namespace {
constexpr double picoseconds_of_us = 1e6;
}

void HostFeed::begin_range(std::uint32_t range) {
    const double cycles = pass_->term(range).feed_us * picoseconds_of_us / static_cast<double>(clock().period);
    begin_ = std::max(end_, cycle());
    end_ = begin_ + static_cast<sim::Cycle>(std::llround(cycles));
    pass_number_ = pass_->number;
    range_ = range;
}

sim::Cycle HostFeed::known_at(std::uint32_t primitive) const {
    const DrawRange& range = pass_->range(range_);
    const std::uint64_t index = primitive - range.first_primitive + 1;
    return begin_ +
           static_cast<sim::Cycle>(static_cast<double>(end_ - begin_) * static_cast<double>(index) / range.primitives);
}

sim::Activity HostFeed::tick() {
    bool progress = false;
    while (const IndexedPrimitive* primitive = primitives_in.peek()) {
        if (primitive->range != range_ || pass_->number != pass_number_) begin_range(primitive->range);
        const sim::Cycle known = known_at(primitive->primitive);
        if (known > cycle()) {
            stats_.wait_cycles += known - std::clamp(waited_, cycle(), known);
            waited_ = known;
            wake_at(known);
            return progress ? sim::Activity::busy : sim::Activity::memory;
        }
        if (!primitives_out.ready()) return progress ? sim::Activity::busy : sim::Activity::blocked;
        primitives_out.send(*primitive);
        primitives_in.pop();
        ++stats_.primitives;
        progress = true;
    }
    return progress ? sim::Activity::busy : sim::Activity::starved;
}

} // namespace pipeline
