// Small components of random networks: each does one thing to the messages that pass it.
#pragma once

#include "tests/support/sim_kit.hpp"

#include <cstdint>
#include <deque>
#include <utility>

namespace tests {

/// A message and, mixed into one number, everything that happened to it.
using Token = std::uint64_t;
inline Token mixed(Token token, std::uint64_t with) {
    token = (token ^ with) * 0x9e3779b97f4a7c15U;
    return token ^ (token >> 29U);
}

/// Keeps each message for some cycles.
class Delay final : public sim::Component {
  public:
    sim::In<Token> in{*this, "in"};
    sim::Out<Token> out{*this, "out"};
    Delay(sim::Context context, sim::Cycle latency, std::size_t capacity)
        : Component(std::move(context)), latency_(latency), capacity_(capacity) {}

  private:
    sim::Activity tick() override {
        bool moved = false;
        for (; !held_.empty() && held_.front().first <= cycle() && out.ready(); moved = true) {
            out.send(held_.front().second);
            held_.pop_front();
        }
        for (; held_.size() < capacity_ && in.peek() != nullptr; moved = true)
            held_.emplace_back(cycle() + latency_, in.receive());
        if (moved) return sim::Activity::busy;
        if (held_.empty()) return sim::Activity::starved;
        if (held_.front().first <= cycle()) return sim::Activity::blocked;
        wake_at(held_.front().first);
        return sim::Activity::memory;
    }
    sim::Cycle latency_;
    std::size_t capacity_;
    std::deque<std::pair<sim::Cycle, Token>> held_;
};

/// Sends each message to the one or the other side, or to both.
class Fork final : public sim::Component {
  public:
    sim::In<Token> in{*this, "in"};
    sim::Out<Token> left{*this, "left"}, right{*this, "right"};
    Fork(sim::Context context, bool both) : Component(std::move(context)), both_(both) {}

  private:
    sim::Activity tick() override {
        bool moved = false;
        for (const Token* token = in.peek(); token != nullptr; token = in.peek(), moved = true) {
            const bool to_left = both_ || *token % 2 == 0;
            const bool to_right = both_ || !to_left;
            if ((to_left && !left.ready()) || (to_right && !right.ready()))
                return moved ? sim::Activity::busy : sim::Activity::blocked;
            if (to_left) left.send(*token);
            if (to_right) right.send(*token);
            in.pop();
        }
        return moved ? sim::Activity::busy : sim::Activity::starved;
    }
    bool both_;
};

/// Takes from two sides in turn, as long as both have something.
class Join final : public sim::Component {
  public:
    sim::In<Token> left{*this, "left"}, right{*this, "right"};
    sim::Out<Token> out{*this, "out"};
    using Component::Component;

  private:
    sim::Activity tick() override {
        bool moved = false;
        for (; left.peek() != nullptr || right.peek() != nullptr; moved = true) {
            if (!out.ready()) return moved ? sim::Activity::busy : sim::Activity::blocked;
            const bool from_left = right.peek() == nullptr || (left_next_ && left.peek() != nullptr);
            out.send(mixed(from_left ? left.receive() : right.receive(), from_left ? 1 : 2));
            left_next_ = !from_left;
        }
        return moved ? sim::Activity::busy : sim::Activity::starved;
    }
    bool left_next_ = true;
};

/// Lets a fixed number of messages in; each gives its place back through `returns`.
class Gate final : public sim::Component {
  public:
    sim::In<Token> in{*this, "in"}, returns{*this, "returns"};
    sim::Out<Token> out{*this, "out"};
    Gate(sim::Context context, std::uint32_t places) : Component(std::move(context)), places_(places) {}

  private:
    sim::Activity tick() override {
        bool moved = false;
        for (; returns.peek() != nullptr; moved = true) {
            returns.pop();
            ++places_;
        }
        for (; in.peek() != nullptr && places_ > 0 && out.ready(); moved = true) {
            out.send(in.receive());
            --places_;
        }
        if (moved) return sim::Activity::busy;
        if (in.peek() == nullptr) return sim::Activity::starved;
        return places_ == 0 ? sim::Activity::hazard : sim::Activity::blocked;
    }
    std::uint32_t places_;
};

} // namespace tests
