// Speed of the event core: ticks and messages per second on one core.
#include "sim/channel.hpp"
#include "sim/simulation.hpp"

#include <benchmark/benchmark.h>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>

namespace {

constexpr std::uint64_t cycles_per_run = 100'000;

/// The least a component can do.
class Ticker final : public sim::Component {
  public:
    explicit Ticker(sim::Context context) : Component(std::move(context)) {}

  private:
    sim::Activity tick() override { return cycle() < cycles_per_run ? sim::Activity::busy : sim::Activity::idle; }
};

/// Sends up to the width of its channel per cycle.
class Generator final : public sim::Component {
  public:
    sim::Out<std::uint64_t> out{*this, "out"};
    Generator(sim::Context context, std::uint64_t count) : Component(std::move(context)), left_(count) {}

  private:
    sim::Activity tick() override {
        if (left_ == 0) return sim::Activity::idle;
        if (!out.ready()) return sim::Activity::blocked;
        do out.send(left_--);
        while (left_ > 0 && out.ready());
        return sim::Activity::busy;
    }
    std::uint64_t left_;
};

class Consumer final : public sim::Component {
  public:
    sim::In<std::uint64_t> in{*this, "in"};
    explicit Consumer(sim::Context context, sim::Cycle every = 1) : Component(std::move(context)), every_(every) {}
    std::uint64_t sum() const { return sum_; }

  private:
    sim::Activity tick() override {
        if (in.peek() == nullptr) return sim::Activity::starved;
        if (cycle() < next_) {
            wake_at(next_);
            return sim::Activity::memory;
        }
        while (const std::uint64_t* value = in.peek()) {
            sum_ += *value;
            in.pop();
        }
        next_ = cycle() + every_;
        return sim::Activity::busy;
    }
    sim::Cycle every_;
    sim::Cycle next_ = 0;
    std::uint64_t sum_ = 0;
};

class Relay final : public sim::Component {
  public:
    sim::In<std::uint64_t> in{*this, "in"};
    sim::Out<std::uint64_t> out{*this, "out"};
    using Component::Component;

  private:
    sim::Activity tick() override {
        if (in.peek() == nullptr) return sim::Activity::starved;
        if (!out.ready()) return sim::Activity::blocked;
        do out.send(in.receive());
        while (in.peek() != nullptr && out.ready());
        return sim::Activity::busy;
    }
};

/// A generator, relays, a consumer. Relays alternate between the clocks.
struct Pipeline {
    sim::Simulation simulation;
    std::unique_ptr<Generator> generator;
    std::deque<std::unique_ptr<Relay>> relays;
    std::unique_ptr<Consumer> consumer;

    Pipeline(int relay_count, std::uint64_t count, std::uint32_t width, sim::Cycle consume_every, bool two_clocks) {
        const sim::Clock& core = simulation.add_clock("core", 650);
        const sim::Clock& other = two_clocks ? simulation.add_clock("memory", 400) : core;
        const auto config = sim::ChannelConfig{.latency = 1, .width = width, .capacity = width * 4};
        generator = std::make_unique<Generator>(simulation.context("generator", core), count);
        consumer = std::make_unique<Consumer>(simulation.context("consumer", core), consume_every);
        for (int i = 0; i < relay_count; ++i)
            relays.push_back(
                std::make_unique<Relay>(simulation.context("relay" + std::to_string(i), i % 2 == 0 ? core : other)));
        sim::Out<std::uint64_t>* last = &generator->out;
        for (const auto& relay : relays) {
            sim::connect(*last, relay->in, config);
            last = &relay->out;
        }
        sim::connect(*last, consumer->in, config);
    }
};

void rate(benchmark::State& state, const char* name, std::uint64_t count) {
    state.counters[name] = benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsRate);
}

void ticks_of_trivial_stages(benchmark::State& state) {
    std::uint64_t ticks = 0;
    for ([[maybe_unused]] auto _ : state) {
        sim::Simulation simulation;
        const sim::Clock& clock = simulation.add_clock("core", 650);
        std::deque<std::unique_ptr<Ticker>> tickers;
        for (int i = 0; i < state.range(0); ++i)
            tickers.push_back(std::make_unique<Ticker>(simulation.context("ticker" + std::to_string(i), clock)));
        simulation.run();
        ticks += simulation.ticks();
    }
    rate(state, "ticks", ticks);
}
BENCHMARK(ticks_of_trivial_stages)->Arg(1)->Arg(4)->Arg(16)->Arg(64)->Unit(benchmark::kMillisecond);

void run_pipelines(benchmark::State& state, int relays, std::uint32_t width, sim::Cycle every, bool two_clocks) {
    const std::uint64_t count = cycles_per_run * width / every;
    std::uint64_t ticks = 0, messages = 0;
    for ([[maybe_unused]] auto _ : state) {
        Pipeline pipeline(relays, count, width, every, two_clocks);
        pipeline.simulation.run();
        benchmark::DoNotOptimize(pipeline.consumer->sum());
        ticks += pipeline.simulation.ticks();
        messages += count * static_cast<std::uint64_t>(relays + 1);
    }
    rate(state, "ticks", ticks);
    rate(state, "messages", messages);
}

void messages_through_a_channel(benchmark::State& state) {
    run_pipelines(state, 0, static_cast<std::uint32_t>(state.range(0)), 1, false);
}
BENCHMARK(messages_through_a_channel)->Arg(1)->Arg(4)->Arg(16)->Unit(benchmark::kMillisecond);

void messages_through_16_relays(benchmark::State& state) {
    run_pipelines(state, 16, static_cast<std::uint32_t>(state.range(0)), 1, false);
}
BENCHMARK(messages_through_16_relays)->Arg(1)->Arg(4)->Unit(benchmark::kMillisecond);

void messages_across_two_clocks(benchmark::State& state) {
    run_pipelines(state, 16, static_cast<std::uint32_t>(state.range(0)), 1, true);
}
BENCHMARK(messages_across_two_clocks)->Arg(1)->Arg(4)->Unit(benchmark::kMillisecond);

/// One slow stage: everybody sleeps most of the time.
void messages_behind_a_slow_stage(benchmark::State& state) {
    run_pipelines(state, 16, 1, static_cast<sim::Cycle>(state.range(0)), false);
}
BENCHMARK(messages_behind_a_slow_stage)->Arg(16)->Arg(2000)->Unit(benchmark::kMillisecond);

} // namespace
