// The only link between components: a pipelined wire with latency, width and a bounded buffer at its end.
//
// A message sent at an edge becomes receivable `latency` sender cycles later. At most `width` messages enter and at
// most `width` leave per edge. `capacity` counts every message between send and receive, those in flight included; the
// room of a received message returns to the sender at its first edge after the one of the receive. For full throughput
// between equal clocks choose capacity >= width * (latency + 1).
#pragma once

#include "sim/channel_base.hpp"
#include "sim/input_set.hpp"

#include <bit>
#include <string_view>
#include <type_traits>
#include <utility>

namespace sim {

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
