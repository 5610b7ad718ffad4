// The only link between components: a pipelined wire with latency, width and a bounded buffer at its end.
//
// A message sent at an edge becomes receivable `latency` sender cycles later. At most `width` messages enter and at
// most `width` leave per edge. `capacity` counts every message between send and receive, those in flight included; the
// room of a received message returns to the sender at its first edge after the one of the receive. For full throughput
// between equal clocks choose capacity >= width * (latency + 1).
#pragma once

#include "sim/check.hpp"
#include "sim/component.hpp"
#include "sim/simulation.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <string_view>
#include <type_traits>
#include <utility>

namespace sim {

struct ChannelConfig {
    Cycle latency = 1;          ///< sender cycles from send to receive, at least 1
    std::uint32_t width = 1;    ///< messages per edge, at least 1
    std::uint32_t capacity = 0; ///< messages between send and receive; 0 = width * (latency + 1)
};

/// Which of a component's inputs hold a message, one that is on its way included: a unit with many ports asks here
/// and not at each of them. Belongs to the component and outlives its ports; for up to 256 of them.
class InputSet {
  public:
    static constexpr std::uint32_t most = 256;

    /// Calls `visit` with the numbers of those from `begin` to before `end` in turn, until it returns true; whether it
    /// did.
    template <class Visit>
    bool any(std::uint32_t begin, std::uint32_t end, Visit visit) const {
        for (std::uint32_t word = begin / 64; word < words_ && 64 * word < end; ++word) {
            std::uint64_t left = held_[word];
            if (word == begin / 64) left &= ~std::uint64_t{0} << begin % 64;
            for (; left != 0; left &= left - 1) {
                const std::uint32_t input = word * 64 + static_cast<std::uint32_t>(std::countr_zero(left));
                if (input >= end) return false;
                if (visit(input)) return true;
            }
        }
        return false;
    }
    /// All of them in turn, from `first` on and round.
    template <class Visit>
    bool any_from(std::uint32_t first, Visit visit) const {
        return any(first, most, visit) || any(0, first, visit);
    }
    bool empty() const {
        return std::all_of(held_.begin(), held_.begin() + words_, [](std::uint64_t word) { return word == 0; });
    }

  private:
    template <class T>
    friend class In;
    std::uint64_t& word_of(std::uint32_t input) {
        CHECK(input < most);
        words_ = std::max(words_, input / 64 + 1);
        return held_[input / 64];
    }
    std::array<std::uint64_t, most / 64> held_{};
    std::uint32_t words_ = 0; ///< in use
};

/// The simulation a component belongs to.
Simulation& simulation_of(Component& component);
/// Registers a channel with its simulation, which then owns it, and with its two ends; used by connect().
ChannelBase& adopt(Simulation& simulation, std::unique_ptr<ChannelBase> channel);

class ChannelBase {
  public:
    virtual ~ChannelBase() = default;
    ChannelBase(const ChannelBase&) = delete;
    ChannelBase& operator=(const ChannelBase&) = delete;

    const std::string& name() const { return name_; }
    const ChannelConfig& config() const { return config_; }
    Component& sender() const { return *sender_; }
    Component& receiver() const { return *receiver_; }
    /// Messages between send and receive.
    std::uint64_t size() const { return sent_ - received_; }
    std::uint64_t sent() const { return sent_; }
    std::uint64_t received() const { return received_; }
    bool empty() const { return sent_ == received_; }
    bool full() const { return size() >= config_.capacity; }
    /// Messages sent and not received before the present instant: what the sender can know, whatever the order of
    /// ticks.
    std::uint64_t outstanding() const {
        return sent_ - (receive_time_ == simulation_->now() ? received_before_ : received_);
    }

  protected:
    ChannelBase(std::string name, ChannelConfig config, Component& sender, Component& receiver);

    // What the sender may still send at this instant is settled at its first question: room freed at the same instant
    // is not visible before its next edge.
    bool can_send() {
        if (simulation_->now() != send_time_) begin_sending();
        if (room_ > 0) return true;
        wait_for_room();
        return false;
    }
    void note_send() {
        --room_;
        ++sent_;
        *held_ |= held_bit_;
        if (woken_for_ != ready_) {
            woken_for_ = ready_;
            wake_receiver();
        }
        if (Observer* observer = simulation_->observer(); observer != nullptr) [[unlikely]]
            observer->message(*this, send_time_, ready_);
    }
    bool can_receive(Time ready) const {
        const Time now = simulation_->now();
        return ready <= now && (receive_time_ != now || width_received_ < config_.width);
    }
    void note_receive() {
        if (const Time now = simulation_->now(); receive_time_ != now) {
            receive_time_ = now;
            received_before_ = received_;
            width_received_ = 0;
        }
        ++received_;
        ++width_received_;
        if (empty()) *held_ &= ~held_bit_;
        if (sender_waits_) wake_sender();
    }

    // Members in the order in which a send and a receive touch them.
    Simulation* simulation_;
    std::uint64_t sent_ = 0;
    std::uint64_t received_ = 0;
    std::uint64_t received_before_ = 0; ///< receives before the instant `receive_time_`
    Time receive_time_ = no_time;       ///< instant of the last receive
    Time send_time_ = no_time;          ///< instant of the last question for room
    Time ready_ = 0;                    ///< when a message sent at `send_time_` is receivable
    Time woken_for_ = no_time;          ///< the last `ready_` that the receiver is woken for
    std::uint32_t room_ = 0;            ///< messages that may still be sent at `send_time_`
    std::uint32_t width_received_ = 0;  ///< messages received at `receive_time_`
    bool sender_waits_ = false;
    std::uint64_t held_bit_ = 0; ///< of the receiver's InputSet
    std::uint64_t* held_ = &held_bit_;

  private:
    template <class T>
    friend class In;
    friend ChannelBase& adopt(Simulation& simulation, std::unique_ptr<ChannelBase> channel);

    static constexpr Time no_time = ~Time{0};

    void begin_sending();
    void wait_for_room();
    void wake_receiver();
    void wake_sender();

    std::string name_;
    ChannelConfig config_;
    Component* sender_;
    Component* receiver_;
    Time delay_; ///< latency in picoseconds
    bool same_clock_;
};

template <class T>
class Channel final : public ChannelBase {
    static_assert(std::is_trivially_copyable_v<T>, "messages are values in rings");

  public:
    Channel(std::string name, ChannelConfig config, Component& sender, Component& receiver)
        : ChannelBase(std::move(name), config, sender, receiver),
          mask_(std::bit_ceil(this->config().capacity) - 1),
          ring_(std::make_unique<Entry[]>(mask_ + 1)) {}

    bool ready() { return can_send(); }

    void send(const T& message) {
        CHECK_MSG(can_send(), name());
        Entry& entry = ring_[sent_ & mask_];
        entry.value = message;
        entry.ready = ready_;
        note_send();
    }

    T* peek() {
        if (empty()) return nullptr;
        Entry& entry = ring_[received_ & mask_];
        return can_receive(entry.ready) ? &entry.value : nullptr;
    }

    void pop() {
        CHECK_MSG(peek() != nullptr, name());
        note_receive();
    }

    const T* try_receive() {
        const T* message = peek();
        if (message != nullptr) note_receive();
        return message; // no send can come between and overwrite it
    }

    T receive() {
        const T* message = try_receive();
        CHECK_MSG(message != nullptr, name());
        return *message;
    }

  private:
    struct Entry {
        T value;
        Time ready;
    };
    std::uint64_t mask_;
    std::unique_ptr<Entry[]> ring_;
};

/// Throws InternalError: a port was used that connect() has not linked.
[[noreturn]] void unlinked(const Component& owner, std::string_view port);

template <class T>
class In;
template <class T>
class Out;

/// Links `out` to `in`; each may be linked once. The channel belongs to the simulation and is named
/// "sender.port -> receiver.port".
template <class T>
ChannelBase& connect(Out<T>& out, In<T>& in, ChannelConfig config);

template <class T>
class Out {
  public:
    explicit Out(Component& owner, std::string_view name) : owner_(&owner), name_(name) {}
    bool connected() const { return channel_ != nullptr; }
    /// Room and width are left at this edge. When false, the owner is woken as soon as that changes.
    bool ready() { return linked().ready(); }
    /// ready() must be true.
    void send(const T& message) { linked().send(message); }
    /// Messages sent and not received before this edge.
    std::uint64_t outstanding() const { return linked().outstanding(); }
    const ChannelBase* channel() const { return channel_; }

  private:
    template <class U>
    friend ChannelBase& connect(Out<U>&, In<U>&, ChannelConfig);
    Channel<T>& linked() const {
        if (channel_ == nullptr) [[unlikely]]
            unlinked(*owner_, name_);
        return *channel_;
    }

    Component* owner_;
    std::string_view name_;
    Channel<T>* channel_ = nullptr;
};

template <class T>
class In {
  public:
    explicit In(Component& owner, std::string_view name) : owner_(&owner), name_(name) {}
    /// One of many, number `index` of `set`.
    In(Component& owner, std::string_view name, InputSet& set, std::uint32_t index)
        : owner_(&owner), name_(name), held_(&set.word_of(index)), held_bit_(std::uint64_t{1} << index % 64) {}
    bool connected() const { return channel_ != nullptr; }
    /// The oldest message that has arrived, or nullptr; nullptr too once `width` messages were received at this edge.
    T* peek() { return linked().peek(); }
    /// Takes the oldest message that has arrived, if there is one; valid during this tick.
    const T* try_receive() { return linked().try_receive(); }
    /// Takes the message that peek() showed.
    T receive() { return linked().receive(); }
    /// Drops the message that peek() showed.
    void pop() { linked().pop(); }
    bool drained() const { return linked().empty(); } ///< nothing buffered and nothing in flight
    const ChannelBase* channel() const { return channel_; }

  private:
    template <class U>
    friend ChannelBase& connect(Out<U>&, In<U>&, ChannelConfig);
    Channel<T>& linked() const {
        if (channel_ == nullptr) [[unlikely]]
            unlinked(*owner_, name_);
        return *channel_;
    }

    void link(Channel<T>& channel) {
        channel_ = &channel;
        if (held_ == nullptr) return;
        channel.held_ = held_;
        channel.held_bit_ = held_bit_;
    }

    Component* owner_;
    std::string_view name_;
    std::uint64_t* held_ = nullptr;
    std::uint64_t held_bit_ = 0;
    Channel<T>* channel_ = nullptr;
};

template <class T>
ChannelBase& connect(Out<T>& out, In<T>& in, ChannelConfig config) {
    CHECK_MSG(out.channel_ == nullptr && in.channel_ == nullptr, "port linked twice");
    auto channel = std::make_unique<Channel<T>>(out.owner_->name() + "." + std::string(out.name_) + " -> " +
                                                    in.owner_->name() + "." + std::string(in.name_),
                                                config, *out.owner_, *in.owner_);
    out.channel_ = channel.get();
    in.link(*channel);
    return adopt(simulation_of(*out.owner_), std::move(channel));
}

} // namespace sim
