// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "lockstep/fault.hpp"
#include "master/steps/position_source.hpp"
#include "master/steps/step_source.hpp"
#include "sand/replica.hpp"
#include "scene/scene.hpp"

namespace master {

/// Gives every step its number, or leaves that to the haptic server: exactly one of them per epoch.
///
/// While a server with sand of its own is linked it numbers; else the master does, with the tool where a server without
/// sand says, or hovering, so that sand never freezes in mid-slide. Every change is a new epoch. Main thread only.
class LiveSteps : public StepSource, public StepRequests {
public:
    /// At the start a haptic server is waited for this long before the master numbers by itself [s].
    static constexpr double kStartWait = 10;
    /// A server that has been handed the numbering and does not begin within this time is passed over [s].
    static constexpr double kGrantWait = 5;
    static constexpr double kRetryWait = 30;  // [s] until it is tried again

    /// Epochs begin above `epoch`, the last of a session that goes on. Every timeout uses `clock`, also those of
    /// the link.
    LiveSteps(std::optional<haptic_bridge::Address> server, const scene::Scene& scene, Pace pace,
              std::uint32_t epoch = 0, haptic_bridge::LinkSecurity security = {}, haptic_bridge::LinkClock clock = {});

    [[nodiscard]] std::vector<haptic_bridge::TimedStep> next(const sand::Replica& terrain, std::uint64_t stateHash,
                                                             std::size_t most) override;
    [[nodiscard]] std::size_t mostPerFrame() const override { return pace_ == Pace::fast ? 4 : 8; }
    /// A fast session waits for a step before it shows a frame without.
    [[nodiscard]] double patience() const override { return pace_ == Pace::fast ? 0.1 : 0; }
    [[nodiscard]] StepRequests* requests() override { return this; }
    void request(sand::Edit edit) override { edits_.push_back(std::move(edit)); }
    void shareForce(double share) override { share_ = share; }

    void shown(std::uint64_t stepNumber, std::int64_t frameIntervalNs) override;
    /// The server starts again from the wall's state. True also if no linked server has numbered the steps.
    [[nodiscard]] bool proveServer(const std::vector<haptic_bridge::TimedStep>& steps,
                                   std::uint64_t stateHash) override;
    [[nodiscard]] std::vector<base::Bytes> ticks() override;
    void drill(const lockstep::Fault& fault) override { drills_.push_back(fault); }

    /// Whether steps are still awaited from a server that has only just started.
    [[nodiscard]] bool starting() const { return source_ == Source::starting; }
    [[nodiscard]] bool linked() const override { return source_ == Source::server; }
    [[nodiscard]] bool streaming() const override { return source_ == Source::own && positions_.streaming(); }
    [[nodiscard]] const char* hand() const override;
    [[nodiscard]] std::uint32_t epoch() const override { return epoch_; }
    [[nodiscard]] std::int64_t clockOffsetNs() const override { return client_ ? client_->clockOffsetNs() : 0; }
    [[nodiscard]] std::optional<haptic_bridge::Report> report() const override;
    [[nodiscard]] haptic_bridge::LinkCounters counters() const override;
    void stop() override;

private:
    enum class Source : std::uint8_t { starting, server, granting, own };

    void followLink(const sand::Replica& terrain, std::uint64_t stateHash);
    void startDrills();
    void sayLink(const haptic_bridge::LinkStatus& status);
    void grant(const sand::Replica& terrain, std::uint64_t stateHash);
    /// `reason` is the word for programs, `why` the words for people; both empty where nothing was lost.
    void takeOver(const std::string& reason = "", const std::string& why = "");
    void leaveServer();
    void distrustServer();
    void connect();
    [[nodiscard]] double secondsSince(std::int64_t then) const;
    [[nodiscard]] std::size_t ownStepsDue();
    void followPositions(const haptic_bridge::LinkStatus& status, const sand::Replica& terrain);
    void passEdits(const std::vector<haptic_bridge::TimedStep>& steps);
    [[nodiscard]] std::vector<haptic_bridge::TimedStep> stepsDue(const sand::Replica& terrain, std::uint64_t stateHash,
                                                                 std::size_t most);

    std::optional<haptic_bridge::Address> server_;
    haptic_bridge::Offer offer_;
    haptic_bridge::LinkSecurity security_;
    haptic_bridge::LinkClock now_;
    haptic_bridge::StepRing recent_;
    int stepsPerSecond_;
    Pace pace_;
    std::unique_ptr<haptic_bridge::Client> client_;
    Source source_;
    std::uint32_t epoch_;
    std::uint64_t linkChanges_ = 0;  // of which the user has been told
    std::int64_t waitingSinceNs_;    // for a server to answer, or to begin
    haptic_bridge::LinkCounters earlierLinks_;
    std::optional<haptic_bridge::Report> earlierReport_;
    std::deque<sand::Edit> edits_;  // asked for, and in no step yet
    PositionSource positions_;
    std::vector<base::Bytes> ticks_;       // of a server that was let go
    std::vector<lockstep::Fault> drills_;  // that wait for a link
    double share_ = 1;                     // of the force
    double toldShare_ = 1;                 // that the server knows
    std::uint32_t toldEpoch_ = 0;          // in which the server was asked for the first of them
    double ownStepsOwed_ = 0;
    std::int64_t lastOwnNs_ = 0;
};

}  // namespace master
