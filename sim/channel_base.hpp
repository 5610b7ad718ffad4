// What a channel knows without the type of its messages: how many there are, when they arrive, who waits.
#pragma once

#include "sim/check.hpp"
#include "sim/component.hpp"
#include "sim/simulation.hpp"

#include <memory>
#include <string>

namespace sim {

template <class T>
class In;

struct ChannelConfig {
    Cycle latency = 1;          ///< sender cycles from send to receive, at least 1
    std::uint32_t width = 1;    ///< messages per edge, at least 1
    std::uint32_t capacity = 0; ///< messages between send and receive; 0 = width * (latency + 1)
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

} // namespace sim
