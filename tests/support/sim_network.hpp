// Random networks of small components on several clocks, and all that can be observed of a run of one.
#pragma once

#include "tests/support/sim_network_parts.hpp"

#include <memory>

namespace tests {

/// All that can be observed of a run.
struct Observed {
    std::vector<std::vector<std::pair<Token, sim::Time>>> arrivals; ///< by sink
    std::vector<sim::ActivityTimes> activities;                     ///< by component
    sim::Time end = 0;
    std::string error;
    friend bool operator==(const Observed&, const Observed&) = default;
};

/// A network that depends on `seed` alone.
class Network {
  public:
    Network(std::uint64_t seed, sim::Mode mode, std::uint64_t shuffle_seed);

    template <class C, class... Arguments>
    C& add(const std::string& kind, Arguments&&... arguments) {
        const sim::Clock& clock = *clocks_[random_.below(clocks_.size())];
        auto component = std::make_unique<C>(simulation_.context(kind + std::to_string(components_.size()), clock),
                                             std::forward<Arguments>(arguments)...);
        C& added = *component;
        components_.push_back(std::move(component));
        return added;
    }
    template <class T>
    void link(sim::Out<T>& out, sim::In<T>& in) {
        sim::ChannelConfig config;
        config.latency = random_.below(20) == 0 ? 1500 : 1 + random_.below(4);
        config.width = static_cast<std::uint32_t>(1 + random_.below(3));
        if (random_.below(2) == 0) config.capacity = static_cast<std::uint32_t>(1 + random_.below(8));
        sim::connect(out, in, config);
    }
    Observed run();

    sim::Simulation& simulation() { return simulation_; }
    sim::Random& random() { return random_; }
    std::vector<sim::Out<Token>*> open_ends;

  private:
    void grow();
    sim::Out<Token>& take_open_end();
    void add_source();
    void add_pool();

    sim::Simulation simulation_;
    sim::Random random_;
    std::vector<const sim::Clock*> clocks_;
    std::vector<std::unique_ptr<sim::Component>> components_;
    std::vector<Sink<Token>*> sinks_;
};

inline Network::Network(std::uint64_t seed, sim::Mode mode, std::uint64_t shuffle_seed)
    : simulation_(seed, mode, shuffle_seed), random_(seed, "network") {
    for (const double mhz : {650.0, 400.0, 97.0})
        if (clocks_.empty() || random_.below(2) == 0) clocks_.push_back(&simulation_.add_clock("clock", mhz));
    const std::uint64_t sources = 1 + random_.below(3);
    for (std::uint64_t i = 0; i < sources; ++i) add_source();
    const std::uint64_t steps = random_.below(12);
    for (std::uint64_t i = 0; i < steps; ++i) grow();
}

inline sim::Out<Token>& Network::take_open_end() {
    std::swap(open_ends[random_.below(open_ends.size())], open_ends.back());
    sim::Out<Token>& out = *open_ends.back();
    open_ends.pop_back();
    return out;
}

inline void Network::add_source() {
    std::vector<Token> tokens(random_.below(60));
    for (Token& token : tokens) token = random_.below(~std::uint64_t{0});
    const SourceOptions options{.start = random_.below(50), .gap = random_.below(4)};
    open_ends.push_back(&add<Source<Token>>("source", tokens, options).out);
}

// Gate -> delay -> fork to the outside and back to the gate.
inline void Network::add_pool() {
    sim::Out<Token>& from = take_open_end();
    Gate& gate = add<Gate>("gate", static_cast<std::uint32_t>(1 + random_.below(4)));
    Delay& delay = add<Delay>("delay", 1 + random_.below(30), 1 + random_.below(4));
    Fork& fork = add<Fork>("fork", true);
    link(from, gate.in);
    link(gate.out, delay.in);
    link(delay.out, fork.in);
    link(fork.right, gate.returns);
    open_ends.push_back(&fork.left);
}

inline void Network::grow() {
    switch (random_.below(5)) {
    case 0:
        add_source();
        break;
    case 1:
        add_pool();
        break;
    case 2: {
        sim::Out<Token>& from = take_open_end();
        Fork& fork = add<Fork>("fork", random_.below(2) == 0);
        link(from, fork.in);
        open_ends.insert(open_ends.end(), {&fork.left, &fork.right});
        break;
    }
    case 3: {
        if (open_ends.size() < 2) break;
        sim::Out<Token>& left = take_open_end();
        sim::Out<Token>& right = take_open_end();
        Join& join = add<Join>("join");
        link(left, join.left);
        link(right, join.right);
        open_ends.push_back(&join.out);
        break;
    }
    default: {
        sim::Out<Token>& from = take_open_end();
        const sim::Cycle latency = random_.below(10) == 0 ? 3000 : random_.below(20);
        Delay& delay = add<Delay>("delay", latency, 1 + random_.below(6));
        link(from, delay.in);
        open_ends.push_back(&delay.out);
    }
    }
}

inline Observed Network::run() {
    while (!open_ends.empty()) {
        const std::uint64_t pattern = random_.below(3) == 0 ? random_.below(7) : 0;
        auto& sink = add<Sink<Token>>("sink", SinkOptions{.accepts = [pattern](sim::Cycle cycle) {
                                          return pattern == 0 || mixed(cycle, pattern) % 8 >= pattern;
                                      }});
        link(take_open_end(), sink.in);
        sinks_.push_back(&sink);
    }
    Observed observed;
    try {
        simulation_.run();
    } catch (const sim::DeadlockError&) {
        observed.error = "deadlock";
    }
    observed.end = simulation_.now();
    for (const Sink<Token>* sink : sinks_) {
        observed.arrivals.emplace_back();
        for (const auto& arrival : sink->arrivals()) observed.arrivals.back().emplace_back(arrival.value, arrival.time);
    }
    for (const auto& component : components_) observed.activities.push_back(component->activity_times());
    return observed;
}

} // namespace tests
