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
#include "master/steps/pointer_hand.hpp"
#include "master/steps/position_source.hpp"
#include "master/steps/step_source.hpp"
#include "master/steps/tick_budget.hpp"
#include "sand/replica.hpp"
#include "scene/scene.hpp"

namespace master {

/// The steps of a live session. In each epoch exactly one program numbers the steps: the haptic server or the master.
///
/// While a server with sand is linked, the server numbers the steps. Otherwise the master does, so that sand that
/// slides continues to slide. The tool of the master's steps is where a server without sand reports it, or it hovers.
/// Each change begins a new epoch. Main thread only.
///
/// There are two times without steps: at the start, at most kStartWait, and while a server takes over, at most
/// kGrantWait.
class LiveSteps : public StepSource, public StepRequests {
public:
    /// Time at the start for which the master waits for a haptic server before it numbers the steps itself [s].
    static constexpr double kStartWait = 10;
    /// Time within which a server must begin to number the steps when the master has asked it to [s].
    static constexpr double kGrantWait = 5;
    static constexpr double kRetryWait = 30;  // [s] until the master asks such a server again

    /// `epoch` is the last epoch of a resumed session; new epochs have higher numbers. All timeouts use `clock`, also
    /// those of the link.
    LiveSteps(std::optional<haptic_bridge::Address> server, const scene::Scene& scene, Pace pace,
              std::uint32_t epoch = 0, haptic_bridge::LinkSecurity security = {}, haptic_bridge::LinkClock clock = {});

    [[nodiscard]] std::vector<haptic_bridge::TimedStep> next(const sand::Replica& terrain, std::uint64_t stateHash,
                                                             std::size_t most) override;
    [[nodiscard]] std::size_t mostPerFrame() const override { return pace_ == Pace::fast ? 4 : 8; }
    /// Returns how long a frame waits for a step [s]. Only a fast session waits.
    [[nodiscard]] double patience() const override { return pace_ == Pace::fast ? 0.1 : 0; }
    [[nodiscard]] StepRequests* requests() override { return this; }
    void request(sand::Edit edit) override { edits_.push_back(std::move(edit)); }
    void shareForce(double share) override;

    void shown(std::uint64_t stepNumber, std::int64_t frameIntervalNs, haptic_bridge::Held held) override;
    /// If the hashes differ, connects again, so that the server starts from the wall's state.
    [[nodiscard]] bool proveServer(const std::vector<haptic_bridge::TimedStep>& steps,
                                   std::uint64_t stateHash) override;
    [[nodiscard]] std::vector<base::Bytes> ticks() override;
    /// From the first call on, the pointers are the hand. Call it only without a server.
    void pointed(std::span<const lockstep::PointerReport> reports, const sand::Replica& sand,
                 std::int64_t receivedNs) override;
    void drill(const lockstep::Fault& fault) override { drills_.push_back(fault); }

    /// Returns whether the session has just started and still waits for the server.
    [[nodiscard]] bool starting() const { return source_ == Source::starting; }
    [[nodiscard]] bool linked() const override { return source_ == Source::server; }
    [[nodiscard]] bool streaming() const override { return source_ == Source::own && positions_.streaming(); }
    [[nodiscard]] bool handed() const override { return linked() || streaming() || (pointer_ && pointer_->pointed()); }
    [[nodiscard]] std::string lastRefusal() const override;
    [[nodiscard]] const char* hand() const override;
    [[nodiscard]] std::uint32_t epoch() const override { return epoch_; }
    [[nodiscard]] std::int64_t clockOffsetNs() const override { return client_ ? client_->clockOffsetNs() : 0; }
    [[nodiscard]] std::optional<haptic_bridge::Report> report() const override;
    [[nodiscard]] haptic_bridge::LinkCounters counters() const override;
    void stop() override;
    [[nodiscard]] std::optional<bool> serverAtEnd() const override { return serverAtEnd_; }
    [[nodiscard]] bool serverUnhealed() const override { return serverUnhealed_; }

private:
    enum class Source : std::uint8_t { starting, server, granting, own };

    void followLink(const sand::Replica& terrain, std::uint64_t stateHash);
    void startDrills();
    void sayLink(const haptic_bridge::LinkStatus& status);
    void grant(const sand::Replica& terrain, std::uint64_t stateHash);
    /// Lets the master number the steps in a new epoch. `reason` is a name for programs, `why` a text for the user;
    /// both are empty if no link was lost.
    void takeOver(const std::string& reason = "", const std::string& why = "");
    void noteLastReport();
    void leaveServer();
    void distrustServer();
    void connect();
    [[nodiscard]] double secondsSince(std::int64_t then) const;
    [[nodiscard]] std::size_t ownStepsDue();
    /// Fills in the hand's path since the step before.
    void fill(haptic_bridge::TimedStep& own);
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
    std::uint64_t linkChanges_ = 0;  // the last change of the link that was printed
    std::int64_t waitingSinceNs_;    // [ns], since when the master waits for the server
    haptic_bridge::LinkCounters earlierLinks_;
    std::optional<haptic_bridge::Report> earlierReport_;
    std::string earlierFailure_;    // of a client that is gone, see Client::lastFailure()
    std::uint64_t linksNoted_ = 0;  // number of the link whose last report noteLastReport() has judged
    bool memoryChanged_ = false;    // a server has said so, and proveServer() has not told it yet
    bool serverUnhealed_ = false;
    std::optional<bool> serverAtEnd_;
    std::deque<sand::Edit> edits_;  // edits that are not in a step yet
    PositionSource positions_;
    std::optional<PointerHand> pointer_;   // nullopt before pointed()
    std::int64_t pointedNs_ = 0;           // when the last reports arrived
    std::vector<base::Bytes> ticks_;       // of a server whose link the master has ended
    TickBudget tickBudget_;                // of all servers together
    std::vector<lockstep::Fault> drills_;  // faults that wait for a link
    haptic_bridge::ForceShare share_;      // of the force; the whole one until an operator sets it
    std::uint32_t toldEpoch_ = 0;          // epoch in which the server was asked for the first of edits_; 0: not asked
    double ownStepsOwed_ = 0;
    std::int64_t lastOwnNs_ = 0;
};

}  // namespace master
