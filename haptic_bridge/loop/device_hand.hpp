// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "haptic_bridge/hand/hand.hpp"
#include "haptic_bridge/loop/hand_channel.hpp"
#include "sand/replica.hpp"

namespace haptic_bridge {

/// Hand of a device: passes the samples of its ticks to the thread that makes steps, and the sand back to the ticks.
///
/// It is present while a master is linked. Used only by the thread that makes steps.
class DeviceHand : public Hand {
public:
    using Hand::Hand;

    /// Takes the samples that have arrived since the last call. Call it often, also while the hand is not present.
    virtual void drain() {}
    /// Makes the hand feel this sand from now on. `edited` says that its last step held an operator's edit.
    virtual void publish(const sand::Replica& replica, bool edited) = 0;
    /// Copies the same sand again if the last copy is kRefreshNs old, so that the hand can tell sand without steps from
    /// a thread that hangs.
    virtual void refresh(const sand::Replica& /* replica */) {}
    /// Returns when refresh() is due [ns, the host's clock].
    [[nodiscard]] virtual std::int64_t refreshDue() const { return std::numeric_limits<std::int64_t>::max(); }
    static constexpr std::int64_t kRefreshNs = 10'000'000;  // [ns]
    /// Returns whether the times of the samples are on the host's monotonic clock [ns].
    [[nodiscard]] virtual bool onHostClock() const = 0;
    /// Sets why the wall takes no steps, as its last frame told; nullopt before its first frame.
    void hold(std::optional<Held> by) { held_ = by; }

protected:
    [[nodiscard]] std::optional<Held> held() const { return held_; }

private:
    std::optional<Held> held_;
};

/// Hand in real time: a force thread runs the ticks, and both threads meet in a channel without locks.
///
/// If the force thread hangs, for example in a driver, the tool is lifted after kPatienceNs, until samples come again.
class ChannelHand : public DeviceHand {
public:
    static constexpr std::int64_t kPatienceNs = 500'000'000;  // [ns] since the last sample was read
    using Clock = std::function<std::int64_t()>;              // [ns], the clock of HapticTick::tick()

    /// Uses the host's clock.
    ChannelHand(const HapticTick& hand, HandChannel& channel, int stepsPerSecond);
    ChannelHand(const HapticTick& hand, HandChannel& channel, int stepsPerSecond, Clock clock)
        : DeviceHand(stepsPerSecond), hand_(hand), channel_(channel), now_(std::move(clock)) {}
    void begin(const sand::Replica& replica) override;
    void end() override;
    void drain() override;
    void publish(const sand::Replica& replica, bool edited) override;
    void refresh(const sand::Replica& replica) override;
    [[nodiscard]] std::int64_t refreshDue() const override { return copiedNs_ + kRefreshNs; }
    [[nodiscard]] bool onHostClock() const override { return true; }
    /// Counts samples that were lost because the queue was full, too.
    [[nodiscard]] std::uint64_t dropped() const override { return Hand::dropped() + channel_.overflow; }

private:
    void collect() override;
    void copy(const sand::Replica& replica);

    const HapticTick& hand_;
    HandChannel& channel_;
    Clock now_;
    std::uint64_t edits_ = 0;                 // steps with an edit that were published
    std::int64_t copiedNs_ = 0, madeNs_ = 0;  // [ns], of the last copy, and of the first copy of the last step
    std::int64_t stepNs_ = 0;                 // FeltSand::stepNs
};

/// Hand under a virtual clock: the thread that makes steps also runs the ticks of the hand, as fast as it can.
///
/// Step n takes exactly the samples at the virtual milliseconds in ((n−1)/rate, n/rate], counted from the first start.
class VirtualHand : public DeviceHand {
public:
    VirtualHand(HapticTick& hand, const HandChannel& channel, int stepsPerSecond)
        : DeviceHand(stepsPerSecond),
          hand_(hand),
          channel_(channel),
          stepsPerSecond_(static_cast<std::uint64_t>(stepsPerSecond)) {}
    void begin(const sand::Replica& replica) override;
    void publish(const sand::Replica& replica, bool edited) override;
    [[nodiscard]] bool onHostClock() const override { return false; }

private:
    void collect() override;

    HapticTick& hand_;
    const HandChannel& channel_;  // only its recorder is used
    std::uint64_t stepsPerSecond_;
    FeltSand surface_;
    std::uint64_t steps_ = 0;  // number of steps since the first start
};

}  // namespace haptic_bridge
