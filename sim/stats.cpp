#include "sim/stats.hpp"

#include "sim/check.hpp"

namespace sim {

Histogram Histogram::from_parts(std::uint64_t bin_width, std::uint64_t sum, std::uint64_t minimum,
                                std::uint64_t maximum, const Bins& bins) {
    Histogram histogram;
    histogram.bin_width_ = bin_width;
    histogram.sum_ = sum;
    histogram.max_ = maximum;
    histogram.bins_ = bins;
    for (const std::uint64_t bin : bins) histogram.count_ += bin;
    if (histogram.count_ != 0) histogram.min_ = minimum;
    return histogram;
}

void Histogram::merge(const Histogram& other) {
    if (other.count_ == 0) return;
    if (count_ == 0) {
        *this = other;
        return;
    }
    CHECK(bin_width_ == other.bin_width_);
    for (std::size_t bin = 0; bin < bin_count; ++bin) bins_[bin] += other.bins_[bin];
    count_ += other.count_;
    sum_ += other.sum_;
    min_ = std::min(min_, other.min_);
    max_ = std::max(max_, other.max_);
}

Histogram Histogram::since(const Histogram& earlier) const {
    if (earlier.count_ == 0) return *this;
    CHECK(bin_width_ == earlier.bin_width_ && count_ >= earlier.count_);
    Histogram between = *this;
    between.count_ -= earlier.count_;
    if (between.count_ == 0) {
        between = Histogram();
        between.bin_width_ = bin_width_;
        return between;
    }
    between.sum_ -= earlier.sum_;
    for (std::size_t bin = 0; bin < bin_count; ++bin) between.bins_[bin] -= earlier.bins_[bin];
    return between;
}

} // namespace sim
