#include "sim/channel.hpp"

#include <limits>

namespace sim {

namespace {
constexpr Cycle longest_latency = Cycle{1} << 24U;
} // namespace

ChannelBase& adopt(Simulation& simulation, std::unique_ptr<ChannelBase> channel) {
    ChannelBase& adopted = *channel;
    adopted.sender_->outputs_.push_back(&adopted);
    adopted.receiver_->inputs_.push_back(&adopted);
    simulation.channels_.push_back(&adopted);
    simulation.owned_channels_.push_back(std::move(channel));
    return adopted;
}

ChannelBase::ChannelBase(std::string name, ChannelConfig config, Component& sender, Component& receiver)
    : simulation_(&simulation_of(sender)),
      name_(std::move(name)),
      config_(config),
      sender_(&sender),
      receiver_(&receiver),
      delay_(config.latency * sender.clock().period),
      same_clock_(sender.clock().domain == receiver.clock().domain) {
    CHECK_MSG(config_.latency >= 1 && config_.latency <= longest_latency && config_.width >= 1, name_);
    CHECK_MSG(&simulation_of(receiver) == simulation_, name_);
    if (config_.capacity != 0) return;
    const std::uint64_t full_throughput = config_.width * (config_.latency + 1);
    CHECK_MSG(full_throughput <= std::numeric_limits<std::uint32_t>::max() / 2, name_);
    config_.capacity = static_cast<std::uint32_t>(full_throughput);
}

void unlinked(const Component& owner, std::string_view port) {
    check_failed("linked", __FILE__, __LINE__, owner.name() + "." + std::string(port) + " is not linked");
}

void ChannelBase::begin_sending() {
    send_time_ = simulation_->now();
    ready_ = send_time_ + delay_;
    const std::uint64_t seen = receive_time_ == send_time_ ? received_before_ : received_;
    const std::uint64_t spare = config_.capacity - (sent_ - seen);
    room_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(spare, config_.width));
}

void ChannelBase::wake_receiver() {
    if (same_clock_)
        simulation_->wake_at_cycle(*receiver_, sender_->queue_->current() + config_.latency);
    else
        simulation_->wake(*receiver_, ready_);
}

// The sender must not sleep through room that appears at its next edge: either the width of this edge is used up, or a
// receive of this very instant is not visible yet.
void ChannelBase::wait_for_room() {
    const std::uint64_t seen = receive_time_ == send_time_ ? received_before_ : received_;
    if (seen != received_ || sent_ - seen < config_.capacity)
        simulation_->wake_at_cycle(*sender_, sender_->queue_->current() + 1);
    else
        sender_waits_ = true;
}

void ChannelBase::wake_sender() {
    sender_waits_ = false;
    if (same_clock_)
        simulation_->wake_at_cycle(*sender_, receiver_->queue_->current() + 1);
    else
        simulation_->wake(*sender_, simulation_->now() + 1);
}

} // namespace sim
