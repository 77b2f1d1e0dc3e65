// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "haptic_bridge/loop/hand_channel.hpp"
#include "sand/replica.hpp"

namespace haptic_bridge {

/// Link between the hand and the thread that makes steps: gives samples to it, and takes the sand to feel from it.
///
/// Used by that one thread.
class HandFeed {
public:
    HandFeed() = default;
    virtual ~HandFeed() = default;
    HandFeed(const HandFeed&) = delete;
    HandFeed& operator=(const HandFeed&) = delete;

    /// A link begins, on this sand: the hand forgets the link before.
    virtual void begin(const sand::Replica& terrain) = 0;
    /// The link ends: from now on the hand rests.
    virtual void end() = 0;
    /// Adds the samples that have come by themselves to `path`. Without a path they are dropped.
    virtual void collect(PathBuilder* path) = 0;
    /// Adds the samples of the next step where they come only when they are asked for.
    virtual void tickForStep(PathBuilder& path) = 0;
    /// The hand feels this sand from now on.
    virtual void publish(const sand::Replica& terrain) = 0;
    /// Whether times of samples are the host's [ns, monotonic].
    [[nodiscard]] virtual bool onHostClock() const = 0;
    /// Samples that were lost on the way.
    [[nodiscard]] virtual std::uint64_t overflow() const { return 0; }
};

/// In real time: a force thread ticks the hand, and both sides meet in a channel without locks.
class ChannelFeed : public HandFeed {
public:
    ChannelFeed(const HapticTick& hand, HandChannel& channel) : hand_(hand), channel_(channel) {}
    void begin(const sand::Replica& terrain) override;
    void end() override { channel_.moving = false; }
    void collect(PathBuilder* path) override;
    void tickForStep(PathBuilder&) override {}
    void publish(const sand::Replica& terrain) override;
    [[nodiscard]] bool onHostClock() const override { return true; }
    [[nodiscard]] std::uint64_t overflow() const override { return channel_.overflow; }

private:
    const HapticTick& hand_;
    HandChannel& channel_;
};

/// Under a virtual clock: the thread that makes steps ticks the hand itself, as quickly as it can.
///
/// Step n takes exactly the samples at the virtual milliseconds in ((n−1)/rate, n/rate], counted from the first start.
class VirtualFeed : public HandFeed {
public:
    VirtualFeed(HapticTick& hand, const HandChannel& channel, int stepsPerSecond)
        : hand_(hand), channel_(channel), stepsPerSecond_(static_cast<std::uint64_t>(stepsPerSecond)) {}
    void begin(const sand::Replica& terrain) override;
    void end() override {}
    void collect(PathBuilder*) override {}
    void tickForStep(PathBuilder& path) override;
    void publish(const sand::Replica& terrain) override;
    [[nodiscard]] bool onHostClock() const override { return false; }

private:
    HapticTick& hand_;
    const HandChannel& channel_;  // of which it needs the recorder alone
    std::uint64_t stepsPerSecond_;
    FeltSand surface_;
    std::uint64_t steps_ = 0;  // made since the first start
};

}  // namespace haptic_bridge
