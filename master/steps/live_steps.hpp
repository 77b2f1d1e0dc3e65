// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "haptic_bridge/hand/pace.hpp"
#include "haptic_bridge/hand/sweep_budget.hpp"
#include "lockstep/fault.hpp"
#include "master/steps/edits.hpp"
#include "master/steps/given_state.hpp"
#include "master/steps/own_steps.hpp"
#include "master/steps/server_link.hpp"
#include "master/steps/step_source.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

namespace master {

/// The steps of a live session. In each epoch exactly one program numbers the steps: the haptic server or the master.
///
/// While a server with sand is linked, the server numbers the steps. Otherwise the master does, so that sand that
/// slides continues to slide. The tool of the master's steps is where a server without sand reports it, or it hovers.
/// Each change begins a new epoch. Main thread only.
///
/// There are three times without steps: at the start, at most kStartWait after the last progress of a server that reads
/// its scene; while a server takes over, at most kGrantWait, and longer if it needs the whole sand; and while
/// the master numbers the steps and nothing moves (OwnSteps::rests()).
class LiveSteps : public StepSource, public ForceControl {
public:
    /// Time at the start for which the master waits for a haptic server before it numbers the steps itself [s].
    static constexpr double kStartWait = 10;
    /// Time in which a server that reads its scene at the start must get further than ever before [s].
    static constexpr double kLoadingWait = haptic_bridge::kLoadingNs * 1e-9;
    /// Time within which a server must begin to number the steps when the master has asked it to [s].
    static constexpr double kGrantWait = 5;
    /// A server that gets the whole sand has one second more for each so many bytes: it receives and decodes them.
    static constexpr double kLeastStateRate = 4e6;
    static constexpr double kRetryWait = 30;  // [s] until the master asks such a server again

    /// `edits` must outlive this object. Each of them becomes part of a step that next() returns, in their order.
    /// `epoch` is the last epoch of a resumed session; new epochs have higher numbers. All timeouts use `clock`, also
    /// those of the link.
    LiveSteps(std::optional<haptic_bridge::Address> server, const scene::Scene& scene, Edits& edits,
              haptic_bridge::Pace pace, std::uint32_t epoch = 0, haptic_bridge::LinkSecurity security = {},
              haptic_bridge::LinkClock clock = {}, AtRest atRest = AtRest::makesSteps);

    [[nodiscard]] ArrivedSteps next(const sand::Replica& replica, std::uint64_t stateHash, std::size_t most) override;
    [[nodiscard]] std::size_t mostPerFrame() const override { return pace_ == haptic_bridge::Pace::fast ? 4 : 8; }
    /// Returns how long a frame waits for a step [s]. Only a fast session waits.
    [[nodiscard]] double patience() const override { return pace_ == haptic_bridge::Pace::fast ? 0.1 : 0; }
    [[nodiscard]] ForceControl* force() override { return this; }
    void shareForce(double share) override { link_.shareForce(share); }
    [[nodiscard]] std::optional<double> forceCeiling() const override { return link_.forceCeiling(); }

    void shown(const haptic_bridge::Shown& frame) override;
    /// If the hashes differ, connects again, so that the server starts from the wall's state.
    [[nodiscard]] bool proveServer(const ArrivedSteps& steps, std::uint64_t stateHash) override;
    /// Ends the link if the server has numbered the steps. Connects again after kRetryWait.
    void refused(const ArrivedSteps& steps, const std::string& why) override;
    [[nodiscard]] std::vector<base::Bytes> ticks() override { return link_.ticks(); }
    /// From the first call on, the pointers are the hand. Call it only without a server.
    void pointed(std::span<const haptic_bridge::PointerReport> reports, double depth, const sand::Replica& sand,
                 std::int64_t receivedNs) override {
        own_.pointed(reports, depth, sand, receivedNs);
    }
    void drill(const lockstep::Fault& fault) override { link_.drill(fault); }

    /// Returns whether the session has just started and still waits for the server.
    [[nodiscard]] bool starting() const { return source_ == Source::starting; }
    [[nodiscard]] bool linked() const override { return source_ == Source::server; }
    [[nodiscard]] bool streaming() const override { return source_ == Source::own && own_.streaming(); }
    [[nodiscard]] bool handed() const override { return linked() || streaming() || own_.pointerMoved(); }
    [[nodiscard]] bool rests() const override { return source_ == Source::own && own_.rests(); }
    [[nodiscard]] std::string lastRefusal() const override { return link_.lastRefusal(); }
    [[nodiscard]] const char* hand() const override;
    [[nodiscard]] std::uint32_t epoch() const override { return epoch_; }
    [[nodiscard]] std::int64_t clockOffsetNs() const override { return link_.clockOffsetNs(); }
    [[nodiscard]] std::optional<haptic_bridge::Report> report() const override { return link_.report(); }
    [[nodiscard]] bool forceTripped() const override { return link_.forceTripped(); }
    [[nodiscard]] haptic_bridge::LinkCounters counters() const override { return link_.counters(); }
    void stop() override;
    [[nodiscard]] std::optional<bool> serverAtEnd() const override { return serverAtEnd_; }
    [[nodiscard]] bool serverUnhealed() const override { return serverUnhealed_; }

private:
    enum class Source : std::uint8_t { starting, server, granting, own };

    [[nodiscard]] ArrivedSteps stepsDue(const sand::Replica& replica, std::uint64_t stateHash, std::size_t most);
    /// Takes the steps of the server that fit into a frame, at least one if one has come, and at most `most`.
    [[nodiscard]] ArrivedSteps drain(const sand::Replica& replica, std::size_t most);
    [[nodiscard]] ArrivedSteps ownSteps(const sand::Replica& replica, std::size_t most);
    void followLink(const sand::Replica& replica, std::uint64_t stateHash);
    /// Follows a link that is neither linked, streaming nor offered.
    void waitForLink(haptic_bridge::Link link);
    void grant(const sand::Replica& replica, std::uint64_t stateHash);
    /// Gives the whole sand to a server that has asked for it. Call it once a frame until it is given.
    void giveState(const sand::Replica& replica);
    /// Lets the master number the steps in a new epoch. `reason` is a name for programs, `why` a text for the user;
    /// both are empty if no link was lost.
    void takeOver(const std::string& reason = "", const std::string& why = "");
    void noteLastReport();
    void distrustServer();
    [[nodiscard]] double secondsSince(std::int64_t then) const;

    haptic_bridge::LinkClock now_;
    ServerLink link_;
    OwnSteps own_;
    Edits& edits_;
    haptic_bridge::SweepBudget budget_;
    haptic_bridge::StepRing recent_;
    GivenState givenState_;
    haptic_bridge::Pace pace_;
    Source source_;
    std::uint32_t epoch_;
    std::int64_t progressNs_ = 0;    // [ns], time at which loadedMost_ has grown; 0: no server has read its scene
    std::uint32_t loadedMost_ = 0;   // most that a server has read of its scene, of haptic_bridge::Loading::kAll
    double grantWait_ = kGrantWait;  // [s], for the server that is granted now
    std::int64_t waitingSinceNs_;    // [ns], since when the master waits for the server
    std::uint64_t linksNoted_ = 0;   // number of the link whose last report noteLastReport() has judged
    bool memoryChanged_ = false;     // a server has reported it, and proveServer() has not returned it yet
    bool serverUnhealed_ = false;
    std::optional<bool> serverAtEnd_;
};

}  // namespace master
