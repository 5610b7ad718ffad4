// A run as a timeline in Chrome's trace format, which Perfetto and chrome://tracing open.
//
// One track per unit with a slice for each activity but idle, and one counter per link with the messages sent in each
// window. Simulated time: one microsecond of the viewer is one microsecond of the GPU.
#pragma once

#include "sim/observer.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace reports {

class Timeline final : public sim::Observer {
  public:
    /// Records at most `max_slices` slices; what comes later is counted and left out.
    explicit Timeline(std::size_t max_slices = 2'000'000) : max_slices_(max_slices) {}

    void activity(const sim::Component& component, sim::Activity activity, sim::Time begin, sim::Time end) override;
    void message(const sim::ChannelBase& channel, sim::Time sent, sim::Time ready) override;

    std::uint64_t slices_left_out() const { return slices_left_out_; }
    /// Writes the file at once, under a temporary name first; throws sim::InputError.
    void write(const std::filesystem::path& path) const;

  private:
    static constexpr sim::Time window = 1'000'000; ///< picoseconds of one point of a counter

    struct Slice {
        std::uint32_t track = 0;
        sim::Activity activity = sim::Activity::idle;
        sim::Time begin = 0, end = 0;
    };

    std::size_t max_slices_;
    std::uint64_t slices_left_out_ = 0;
    std::vector<Slice> slices_;
    std::map<const sim::Component*, std::uint32_t> tracks_;
    std::vector<std::string> track_names_;
    std::map<const sim::ChannelBase*, std::uint32_t> links_;
    std::vector<std::string> link_names_;
    std::vector<std::map<sim::Time, std::uint64_t>> sent_; ///< by link: window -> messages
};

} // namespace reports
