#include "reports/timeline.hpp"

#include "reports/atomic_file.hpp"
#include "sim/channel.hpp"
#include "sim/component.hpp"

#include <fmt/format.h>
#include <iterator>
#include <nlohmann/json.hpp>

namespace reports {

namespace {

// Picoseconds in the viewer's microseconds, without rounding.
std::string microseconds(sim::Time time) { return fmt::format("{}.{:06}", time / 1'000'000, time % 1'000'000); }

template <class Key>
std::uint32_t number_of(std::map<const Key*, std::uint32_t>& numbers, std::vector<std::string>& names, const Key& key) {
    const auto [at, is_new] = numbers.try_emplace(&key, static_cast<std::uint32_t>(names.size()));
    if (is_new) names.push_back(key.name());
    return at->second;
}

} // namespace

void Timeline::activity(const sim::Component& component, sim::Activity activity, sim::Time begin, sim::Time end) {
    if (activity == sim::Activity::idle) return;
    if (slices_.size() >= max_slices_) {
        ++slices_left_out_;
        return;
    }
    slices_.push_back({number_of(tracks_, track_names_, component), activity, begin, end});
}

void Timeline::message(const sim::ChannelBase& channel, sim::Time sent, sim::Time) {
    const std::uint32_t link = number_of(links_, link_names_, channel);
    if (sent_.size() <= link) sent_.resize(link + 1);
    ++sent_[link][sent / window * window];
}

void Timeline::write(const std::filesystem::path& path) const {
    std::string text = "{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n";
    auto out = std::back_inserter(text);
    fmt::format_to(out, R"({{"name":"process_name","ph":"M","pid":1,"args":{{"name":"GPU, simulated time"}}}})");
    for (std::size_t track = 0; track < track_names_.size(); ++track)
        fmt::format_to(out,
                       ",\n"
                       R"({{"name":"thread_name","ph":"M","pid":1,"tid":{},"args":{{"name":{}}}}})",
                       track + 1, nlohmann::json(track_names_[track]).dump());
    for (const Slice& slice : slices_)
        fmt::format_to(out,
                       ",\n"
                       R"({{"name":"{}","ph":"X","pid":1,"tid":{},"ts":{},"dur":{}}})",
                       sim::to_string(slice.activity), slice.track + 1, microseconds(slice.begin),
                       microseconds(slice.end - slice.begin));
    for (std::size_t link = 0; link < sent_.size(); ++link)
        for (const auto& [start, count] : sent_[link])
            fmt::format_to(out,
                           ",\n"
                           R"({{"name":{},"ph":"C","pid":1,"ts":{},"args":{{"messages per microsecond":{}}}}})",
                           nlohmann::json(link_names_[link]).dump(), microseconds(start), count);
    text += "\n]}\n";
    write_file(path, text);
}

} // namespace reports
