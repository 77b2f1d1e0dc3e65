// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "haptic_bridge/devices/mapped_device.hpp"
#include "haptic_bridge/server/force_ceiling.hpp"
#include "haptic_bridge/server/step_maker.hpp"
#include "tests/haptic_bridge/loop/logging_arm.hpp"

namespace test {

/// A whole haptic server and a master under one virtual clock, without threads and sockets: arm, ticks of 1 ms, guards,
/// steps, copies of the sand, and a wall that shows the steps.
class VirtualServer {
public:
    static constexpr std::int64_t kTickNs = 1'000'000;

    /// `scene` must outlive this object. `ceiling` is the server's own share of the force.
    VirtualServer(const scene::Scene& scene, const haptic_bridge::ArmPhysics& arm, LoggingArm::Path path,
                  double ceiling = 1, const haptic_bridge::HandSettings& settings = {})
        : hand_(std::make_unique<haptic_bridge::HapticTick>(
              scene,
              std::make_unique<haptic_bridge::MappedDevice>(std::make_unique<LoggingArm>(arm, std::move(path), pushes),
                                                            settings, scene),
              haptic_bridge::HandSettings::Datum::level)),
          deviceHand_(*hand_, *channel_, scene.rules.stepsPerSecond, [this] { return now_; }),
          maker_(sand::Replica(scene), deviceHand_, output(), [this] { return now_; }),
          sand_(scene),
          ceiling_(ceiling) {
        setShare(std::nullopt);
        hand_->rest(0);
    }

    /// Links a master with the sand that the server has, or with `sand`.
    void link(const haptic_bridge::ForceShare& force = {}, std::optional<sand::Replica> sand = std::nullopt) {
        sand_ = sand ? *std::move(sand) : maker_.sand();
        setShare(force);
        maker_.start(++session_, {++epoch_, sand_.stepNumber(), sand_.stateHash(), force});
        if (!maker_.running()) {
            maker_.state(sand_.encodeState());
        }
        shown_ = sand_.stepNumber();
    }
    /// Ends the link, as when a master leaves or dies.
    void unlink() {
        setShare(std::nullopt);
        maker_.release();
    }
    /// Takes a ForceShare of the linked master, as Peer does.
    void share(const haptic_bridge::ForceShare& sent) {
        setShare(sent);
        if (sent.byOperator && sent.share > 0) {
            hand_->switchOn();
        }
    }
    void edit(sand::Edit edit) { maker_.edit({std::move(edit)}); }

    /// Runs one tick of the force loop, and what the other threads do until then.
    void tick(std::int64_t span = kTickNs) {
        now_ += span;
        if (!sandThreadHangs) {
            runSand();
        }
        const double time = static_cast<double>(handNs_ += channel_->moving ? span : 0) * 1e-9;
        if (!channel_->moving) {
            hand_->rest(time);
            return;
        }
        if (channel_->sitting != sitting_) {
            sitting_ = channel_->sitting;
            channel_->beginSitting(*hand_);
        }
        (void)channel_->samples.push(hand_->tick(time, now_, channel_->surface.latest()));
    }
    void run(double seconds) {
        for (std::int64_t ticks = std::llround(seconds * 1000); ticks > 0; --ticks) {
            tick();
        }
    }
    /// Ends the server in order.
    void end() {
        unlink();
        hand_.reset();
    }

    [[nodiscard]] haptic_bridge::HapticTick& hand() { return *hand_; }
    [[nodiscard]] const haptic_bridge::Tick& last() const { return hand_->lastTick(); }
    [[nodiscard]] sand::force::Vec3 pushed() const { return pushes.back().force; }
    [[nodiscard]] const sand::Replica& sand() const { return maker_.sand(); }
    [[nodiscard]] bool linked() const { return maker_.running(); }
    /// Returns whether the last tick felt sand; otherwise the hand rested.
    [[nodiscard]] bool moving() const { return channel_->moving; }
    /// Returns the number of links so far.
    [[nodiscard]] std::uint32_t sitting() const { return sitting_; }
    /// Returns the sand that the last tick felt.
    [[nodiscard]] const haptic_bridge::FeltSand& felt() { return channel_->surface.latest(); }
    [[nodiscard]] std::uint64_t counted(haptic_bridge::Guard guard) const {
        return hand_->guardCounts().all()[static_cast<std::size_t>(guard)];
    }

    std::vector<Push> pushes;    // that the arm got
    bool sandIsStopped = false;  // the wall shows no steps: a master that hangs, or the reason in `held`
    haptic_bridge::Held held = haptic_bridge::Held::no;  // why the wall shows frames without steps, in sandIsStopped
    haptic_bridge::FrameCost cost;                       // of each frame
    bool forceUntilCtl = false;                          // the server was started with --force-until-ctl
    bool sandThreadHangs = false;                        // the thread that makes steps does nothing
    std::int64_t sweepNs =
        0;  // [ns], cost of a sweep, a sub-step and a coarse phase; 0: the frames of the wall have `cost`
    std::function<void(const base::Bytes& stepMessage)> onStep;

private:
    [[nodiscard]] haptic_bridge::StepMaker::Output output() {
        return {[](std::uint32_t) {}, [](std::uint32_t, haptic_bridge::NeedState) {},
                [](std::uint32_t, const std::string&) {},
                [this](std::uint32_t, const base::Bytes& step, std::uint64_t) {
                    if (onStep) {
                        onStep(step);
                    }
                }};
    }
    void setShare(const std::optional<haptic_bridge::ForceShare>& sent) {
        hand_->shareForce(haptic_bridge::feltShare({ceiling_, forceUntilCtl}, sent));
    }
    /// Returns the frame that shows the last step.
    [[nodiscard]] haptic_bridge::Shown frame() const {
        haptic_bridge::Shown shown{.stepNumber = maker_.sand().stepNumber(), .frameIntervalNs = 16'666'667};
        if (sweepNs > 0) {
            const sand::StepWork& work = maker_.sand().lastWork();
            shown.cost.sweeps = work.sweeps;
            shown.cost.sweepNs = work.sweeps * sweepNs;
            shown.cost.substeps = work.substeps;
            shown.cost.dragNs = work.substeps * sweepNs;
            shown.cost.phases = work.phases;
            shown.cost.phaseNs = work.phases * sweepNs;
        }
        return shown;
    }
    void runSand() {
        maker_.collect();
        if (maker_.running() && now_ >= maker_.due()) {
            maker_.makeStep();
            shown_ = sandIsStopped ? shown_ : maker_.sand().stepNumber();
            if (!sandIsStopped || held != haptic_bridge::Held::no) {
                haptic_bridge::Shown shown = frame();
                shown.stepNumber = shown_;
                shown.held = sandIsStopped ? held : haptic_bridge::Held::no;
                shown.cost = sweepNs > 0 ? shown.cost : cost;
                maker_.shown(shown, now_);
            }
        }
        maker_.refresh();
    }

    std::int64_t now_ = 0, handNs_ = 0;  // [ns]
    std::unique_ptr<haptic_bridge::HandChannel> channel_ = std::make_unique<haptic_bridge::HandChannel>();
    std::unique_ptr<haptic_bridge::HapticTick> hand_;
    haptic_bridge::ChannelHand deviceHand_;
    haptic_bridge::StepMaker maker_;
    sand::Replica sand_;
    double ceiling_;
    std::uint32_t session_ = 0, epoch_ = 0, sitting_ = 0;
    std::uint64_t shown_ = 0;
};

}  // namespace test
