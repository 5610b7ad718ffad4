// What an observer of a run is told.
#include "tests/support/sim_kit.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace core_observer_test {

using sim::Activity;
using sim::Cycle;
using sim::Time;
using tests::Rig;
using tests::Sink;
using tests::Source;

// Notes everything it is told.
class Notes final : public sim::Observer {
  public:
    struct Slice {
        Activity activity;
        Time begin, end;
        friend bool operator==(const Slice&, const Slice&) = default;
    };
    std::map<std::string, std::vector<Slice>> slices;
    std::vector<std::pair<Time, Time>> messages;

    void activity(const sim::Component& component, Activity activity, Time begin, Time end) override {
        slices[component.name()].push_back({activity, begin, end});
    }
    void message(const sim::ChannelBase&, Time sent, Time ready) override { messages.emplace_back(sent, ready); }
};

TEST(Observer, SeesActivitiesAndMessages) {
    for (const sim::Mode mode : {sim::Mode::normal, sim::Mode::shuffled, sim::Mode::never_sleep}) {
        Rig rig(mode);
        Notes notes;
        rig.simulation.set_observer(&notes);
        Source<int> source(rig.context("source"), {1, 2}, {.start = 2, .gap = 3});
        Sink<int> sink(rig.context("sink"));
        sim::connect(source.out, sink.in, {.latency = 2});
        rig.simulation.run();
        EXPECT_EQ(notes.messages, (std::vector<std::pair<Time, Time>>{{2000, 4000}, {5000, 7000}}));
        using Slices = std::vector<Notes::Slice>;
        EXPECT_EQ(notes.slices["source"], (Slices{{Activity::memory, 0, 2000},
                                                  {Activity::busy, 2000, 3000},
                                                  {Activity::memory, 3000, 5000},
                                                  {Activity::busy, 5000, 6000},
                                                  {Activity::idle, 6000, 8000}}));
        EXPECT_EQ(notes.slices["sink"], (Slices{{Activity::starved, 0, 4000},
                                                {Activity::busy, 4000, 5000},
                                                {Activity::starved, 5000, 7000},
                                                {Activity::busy, 7000, 8000}}));
    }
}

TEST(Observer, SlicesTileTheTimeOfEveryComponent) {
    Rig rig;
    Notes notes;
    rig.simulation.set_observer(&notes);
    Source<int> source(rig.context("source"), std::vector<int>(50), {.gap = 2});
    Sink<int> sink(rig.context("sink"), {.accepts = [](Cycle cycle) { return cycle % 7 < 3; }});
    sim::connect(source.out, sink.in, {.latency = 3, .capacity = 4});
    rig.simulation.run();
    for (const auto& [name, slices] : notes.slices) {
        Time end = 0;
        for (const auto& slice : slices) {
            EXPECT_EQ(slice.begin, end) << name;
            EXPECT_GT(slice.end, slice.begin) << name;
            end = slice.end;
        }
        EXPECT_EQ(end, rig.simulation.now()) << name;
    }
}

} // namespace core_observer_test
