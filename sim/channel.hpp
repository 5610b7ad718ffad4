// The only link between components: a pipelined wire with latency, width and a bounded buffer at its end.
//
// A message sent at an edge becomes receivable `latency` sender cycles later. At most `width` messages enter and at most
// `width` leave per edge. `capacity` counts every message between send and receive, those in flight included; the room of
// a received message returns to the sender at its first edge after the one of the receive. For full throughput between
// equal clocks choose capacity >= width * (latency + 1).
#pragma once

#include "sim/check.hpp"
#include "sim/component.hpp"
#include "sim/simulation.hpp"

#include <bit>
#include <string_view>
#include <type_traits>
#include <utility>

namespace sim {

struct ChannelConfig {
    Cycle         latency  = 1; ///< sender cycles from send to receive, at least 1
    std::uint32_t width    = 1; ///< messages per edge, at least 1
    std::uint32_t capacity = 0; ///< messages between send and receive; 0 = width * (latency + 1)
};

/// The simulation a component belongs to, and the transfer of a channel into its ownership; used by connect().
Simulation&  simulation_of(Component& component);
ChannelBase& adopt(Simulation& simulation, std::unique_ptr<ChannelBase> channel);

class ChannelBase {
  public:
    virtual ~ChannelBase() = default;
    ChannelBase(const ChannelBase&)            = delete;
    ChannelBase& operator=(const ChannelBase&) = delete;

    const std::string&   name() const { return name_; }
    const ChannelConfig& config() const { return config_; }
    Component&           sender() const { return *sender_; }
    Component&           receiver() const { return *receiver_; }
    /// Messages between send and receive.
    std::uint64_t size() const { return sent_ - received_; }
    std::uint64_t sent() const { return sent_; }
    std::uint64_t received() const { return received_; }
    bool          empty() const { return sent_ == received_; }
    bool          full() const { return size() >= config_.capacity; }

  protected:
    ChannelBase(Simulation& simulation, std::string name, ChannelConfig config, Component& sender, Component& receiver);

    // What the sender may know: room freed at the present instant is not visible before its next edge.
    bool can_send() {
        const Time now = simulation_->now();
        if (now != width_time_sent_) {
            width_time_sent_ = now;
            width_sent_      = 0;
        }
        const std::uint64_t seen = receive_time_ < now ? received_ : received_before_;
        if (sent_ - seen < config_.capacity && width_sent_ < config_.width) return true;
        wait_for_room(seen);
        return false;
    }
    void note_send() {
        ++sent_;
        ++width_sent_;
        const Time ready = simulation_->now() + config_.latency * sender_->clock().period;
        if (same_clock_)
            simulation_->wake_at_cycle(*receiver_, sender_cycle() + config_.latency);
        else
            simulation_->wake(*receiver_, ready);
        if (Observer* observer = simulation_->observer(); observer != nullptr) [[unlikely]]
            observer->message(*this, simulation_->now(), ready);
    }
    bool can_receive(Time ready) {
        const Time now = simulation_->now();
        if (now < ready) return false;
        return now != receive_time_ || width_received_ < config_.width;
    }
    void note_receive() {
        const Time now = simulation_->now();
        if (now != receive_time_) {
            receive_time_    = now;
            received_before_ = received_;
            width_received_  = 0;
        }
        ++received_;
        ++width_received_;
        if (sender_waits_) {
            sender_waits_ = false;
            wake_sender();
        }
    }
    Cycle sender_cycle() const;
    void  wait_for_room(std::uint64_t seen);
    void  wake_sender();

    Simulation*   simulation_;
    std::string   name_;
    ChannelConfig config_;
    Component*    sender_;
    Component*    receiver_;
    bool          same_clock_;
    bool          sender_waits_     = false;
    std::uint32_t width_sent_       = 0;
    std::uint32_t width_received_   = 0;
    std::uint64_t sent_             = 0;
    std::uint64_t received_         = 0;
    std::uint64_t received_before_  = 0; ///< receives before the instant `receive_time_`
    Time          receive_time_     = ~Time{0} - 1;
    Time          width_time_sent_  = ~Time{0};
};

template <class T>
class Channel final : public ChannelBase {
    static_assert(std::is_trivially_copyable_v<T>, "messages are values in rings");

  public:
    Channel(Simulation& simulation, std::string name, ChannelConfig config, Component& sender, Component& receiver)
        : ChannelBase(simulation, std::move(name), config, sender, receiver),
          mask_(std::bit_ceil(config_.capacity) - 1),
          ring_(std::make_unique<Entry[]>(mask_ + 1)) {}

    bool ready() { return can_send(); }

    void send(const T& message) {
        CHECK_MSG(can_send(), name_);
        Entry& entry = ring_[sent_ & mask_];
        entry.ready  = simulation_->now() + config_.latency * sender_->clock().period;
        entry.value  = message;
        note_send();
    }

    T* peek() {
        if (empty()) return nullptr;
        Entry& entry = ring_[received_ & mask_];
        return can_receive(entry.ready) ? &entry.value : nullptr;
    }

    void pop() { note_receive(); }

  private:
    struct Entry {
        T    value;
        Time ready;
    };
    std::uint64_t            mask_;
    std::unique_ptr<Entry[]> ring_;
};

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
    bool ready() { return channel_->ready(); }
    /// ready() must be true.
    void               send(const T& message) { channel_->send(message); }
    const ChannelBase* channel() const { return channel_; }

  private:
    template <class U>
    friend ChannelBase& connect(Out<U>&, In<U>&, ChannelConfig);
    Component*       owner_;
    std::string_view name_;
    Channel<T>*      channel_ = nullptr;
};

template <class T>
class In {
  public:
    explicit In(Component& owner, std::string_view name) : owner_(&owner), name_(name) {}
    bool connected() const { return channel_ != nullptr; }
    /// The oldest message that has arrived, or nullptr; nullptr too once `width` messages were received at this edge.
    T* peek() { return channel_->peek(); }
    /// Takes the message that peek() showed.
    T receive() {
        T* message = channel_->peek();
        CHECK_MSG(message != nullptr, name_);
        T value = *message;
        channel_->pop();
        return value;
    }
    /// Drops the message that peek() showed; peek() must have returned it at this edge.
    void               pop() { channel_->pop(); }
    bool               drained() const { return channel_->empty(); } ///< nothing buffered and nothing in flight
    const ChannelBase* channel() const { return channel_; }

  private:
    template <class U>
    friend ChannelBase& connect(Out<U>&, In<U>&, ChannelConfig);
    Component*       owner_;
    std::string_view name_;
    Channel<T>*      channel_ = nullptr;
};

template <class T>
ChannelBase& connect(Out<T>& out, In<T>& in, ChannelConfig config) {
    CHECK_MSG(out.channel_ == nullptr && in.channel_ == nullptr, "port linked twice");
    Simulation& simulation = simulation_of(*out.owner_);
    auto        channel    = std::make_unique<Channel<T>>(
        simulation,
        out.owner_->name() + "." + std::string(out.name_) + " -> " + in.owner_->name() + "." + std::string(in.name_),
        config, *out.owner_, *in.owner_);
    out.channel_ = channel.get();
    in.channel_  = channel.get();
    return adopt(simulation, std::move(channel));
}

} // namespace sim
