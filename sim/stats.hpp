// The values that statistics are made of: plain, copyable, comparable; `stats = {}` resets them.
//
// A counter has one meaning. Ratios are not stored: they are derived where they are printed, from two counters.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace sim {

/// Counts events, or sums a quantity.
struct Counter {
    std::uint64_t value = 0;

    Counter& operator++() {
        ++value;
        return *this;
    }
    Counter& operator+=(std::uint64_t amount) {
        value += amount;
        return *this;
    }
    constexpr operator std::uint64_t() const { return value; }
    friend bool operator==(const Counter&, const Counter&) = default;
};

/// The highest level ever seen, for example of a queue.
struct HighWater {
    std::uint64_t value = 0;

    void note(std::uint64_t level) { value = std::max(value, level); }
    constexpr operator std::uint64_t() const { return value; }
    friend bool operator==(const HighWater&, const HighWater&) = default;
};

/// How often each size occurred. Bin 0 holds the value 0 and bin i the values in [2^(i-1), 2^i), unless made by
/// linear(): then bin i holds [i * width, (i + 1) * width), and the last bin everything above.
class Histogram {
  public:
    static constexpr std::size_t bin_count = 65;
    using Bins = std::array<std::uint64_t, bin_count>;

    constexpr Histogram() = default;
    static constexpr Histogram linear(std::uint64_t bin_width) {
        Histogram histogram;
        histogram.bin_width_ = std::max<std::uint64_t>(bin_width, 1);
        return histogram;
    }
    /// From its parts, as read from a file. `minimum` counts only when something was counted.
    static Histogram from_parts(std::uint64_t bin_width, std::uint64_t sum, std::uint64_t minimum,
                                std::uint64_t maximum, const Bins& bins);

    void note(std::uint64_t value, std::uint64_t times = 1) {
        if (times == 0) return;
        bins_[bin_of(value)] += times;
        count_ += times;
        sum_ += value * times;
        min_ = std::min(min_, value);
        max_ = std::max(max_, value);
    }

    std::uint64_t count() const { return count_; }
    std::uint64_t sum() const { return sum_; }
    std::uint64_t min() const { return count_ == 0 ? 0 : min_; } ///< 0 when empty
    std::uint64_t max() const { return max_; }
    double mean() const { return count_ == 0 ? 0.0 : static_cast<double>(sum_) / static_cast<double>(count_); }
    const Bins& bins() const { return bins_; }
    std::uint64_t bin_width() const { return bin_width_; } ///< 0: powers of two

    std::size_t bin_of(std::uint64_t value) const {
        if (bin_width_ == 0) return static_cast<std::size_t>(std::bit_width(value));
        return static_cast<std::size_t>(std::min<std::uint64_t>(value / bin_width_, bin_count - 1));
    }
    /// The smallest value that bin `bin` holds.
    std::uint64_t bin_start(std::size_t bin) const {
        if (bin_width_ != 0) return bin * bin_width_;
        return bin == 0 ? 0 : std::uint64_t{1} << (bin - 1);
    }

    /// Both must have the same bins.
    void merge(const Histogram& other);
    /// What was counted between `earlier` and this. The extremes of that interval are not known: those of this stay.
    Histogram since(const Histogram& earlier) const;

    friend bool operator==(const Histogram&, const Histogram&) = default;

  private:
    std::uint64_t bin_width_ = 0;
    std::uint64_t count_ = 0;
    std::uint64_t sum_ = 0;
    std::uint64_t min_ = ~std::uint64_t{0};
    std::uint64_t max_ = 0;
    Bins bins_{};
};

} // namespace sim
