// A channel between a random sender and a random receiver against a cycle-by-cycle model of it.
#include "tests/support/sim_kit.hpp"

#include <rapidcheck/gtest.h>

namespace core_channel_model_test {

using sim::Cycle;

struct Case {
    sim::ChannelConfig config;
    std::size_t messages;
    Cycle start, gap;
    std::vector<bool> open; ///< whether the receiver takes at a cycle, repeated

    bool open_at(Cycle cycle) const { return open[cycle % open.size()]; }
};

struct Cycles {
    std::vector<Cycle> sent, received;
    friend bool operator==(const Cycles&, const Cycles&) = default;
};

Cycles simulate(const Case& test, sim::Mode mode) {
    tests::Rig rig(mode);
    tests::Source<int> source(rig.context("source"), std::vector<int>(test.messages),
                              {.start = test.start, .gap = test.gap});
    tests::Sink<int> sink(rig.context("sink"), {.accepts = [&](Cycle cycle) { return test.open_at(cycle); }});
    sim::connect(source.out, sink.in, test.config);
    rig.simulation.run();
    return {source.cycles(), sink.cycles()};
}

Cycles model(const Case& test) {
    Cycles cycles;
    auto& [sent, received] = cycles;
    for (Cycle cycle = 0; received.size() < test.messages; ++cycle) {
        const std::size_t received_before = received.size();
        for (std::uint32_t left = test.config.width; left > 0 && received.size() < sent.size(); --left)
            if (sent[received.size()] + test.config.latency <= cycle && test.open_at(cycle)) received.push_back(cycle);
        for (std::uint32_t left = test.config.width; left > 0 && sent.size() < test.messages; --left)
            if (cycle >= test.start + sent.size() * test.gap && sent.size() - received_before < test.config.capacity)
                sent.push_back(cycle);
    }
    return cycles;
}

RC_GTEST_PROP(ChannelModel, AgreesInAllModes, ()) {
    Case test;
    test.config.latency = *rc::gen::inRange<Cycle>(1, 7);
    test.config.width = *rc::gen::inRange<std::uint32_t>(1, 5);
    test.config.capacity = *rc::gen::inRange<std::uint32_t>(1, 20);
    test.messages = *rc::gen::inRange<std::size_t>(0, 60);
    test.start = *rc::gen::inRange<Cycle>(0, 10);
    test.gap = *rc::gen::inRange<Cycle>(0, 4);
    test.open = *rc::gen::container<std::vector<bool>>(rc::gen::arbitrary<bool>());
    test.open.push_back(true);
    const Cycles expected = model(test);
    RC_ASSERT(simulate(test, sim::Mode::normal) == expected);
    RC_ASSERT(simulate(test, sim::Mode::shuffled) == expected);
    RC_ASSERT(simulate(test, sim::Mode::never_sleep) == expected);
}

} // namespace core_channel_model_test
