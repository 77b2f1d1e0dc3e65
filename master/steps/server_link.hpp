// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "lockstep/fault.hpp"
#include "master/steps/server_ticks.hpp"

namespace master {

/// The link to the haptic server of a session, with one client after another. Counters, report and ticks are those of
/// all clients together. Used by one thread.
class ServerLink {
public:
    /// `server` is nullopt if the session has no server. `clock` must not be empty. `fastStepsPerSecond` is as in
    /// TickBudget. Does not connect.
    ServerLink(std::optional<haptic_bridge::Address> server, haptic_bridge::Offer offer,
               haptic_bridge::LinkSecurity security, haptic_bridge::LinkClock clock, int fastStepsPerSecond);

    /// Returns whether the session has a server.
    [[nodiscard]] bool hasServer() const { return server_.has_value(); }
    /// Returns HOST:PORT of the server. Only with a server.
    [[nodiscard]] std::string address() const { return server_->text(); }
    /// Returns the client; null before connect() and after leave().
    [[nodiscard]] haptic_bridge::Client* client() const { return client_.get(); }

    /// Makes a client, which begins to connect.
    void connect();
    /// Ends the link and its client. `why` is the new lastRefusal(); if it is empty, that is the client's.
    void leave(const std::string& why = {});
    /// Returns the state of the link. If it has changed, prints its message and sends the event `link`. Only with a
    /// client.
    [[nodiscard]] haptic_bridge::LinkStatus follow(std::uint32_t epoch);
    /// Forgets lastRefusal() of earlier clients, because the server is linked.
    void forgetRefusal() { earlierFailure_.clear(); }

    /// Sets the share of the force for this client and later ones.
    void shareForce(double share);
    /// Returns haptic_bridge::Client::forceCeiling().
    [[nodiscard]] std::optional<double> forceCeiling() const {
        return client_ ? client_->forceCeiling() : std::nullopt;
    }
    /// Keeps a fault until startDrills().
    void drill(const lockstep::Fault& fault) { drills_.push_back(fault); }
    /// Injects the faults that wait. Only with a client.
    void startDrills();

    /// Counts a step of the server for the budget of its ticks.
    void countStep() { ticks_.step(); }
    /// Returns the pieces of the tick track since the last call.
    [[nodiscard]] std::vector<base::Bytes> ticks();
    void printTicksLeftOut() const { ticks_.printLeftOut(); }

    [[nodiscard]] std::int64_t clockOffsetNs() const { return client_ ? client_->clockOffsetNs() : 0; }
    [[nodiscard]] std::optional<haptic_bridge::Report> report() const;
    /// Returns whether the linked server pushes 0 until an operator switches the force on, because of three faults. It
    /// follows from the last two reports, which come once a second.
    [[nodiscard]] bool forceTripped() const { return tripped_; }
    [[nodiscard]] std::string lastRefusal() const;
    [[nodiscard]] haptic_bridge::LinkCounters counters() const;

private:
    void followReports();

    std::optional<haptic_bridge::Address> server_;
    haptic_bridge::Offer offer_;
    haptic_bridge::LinkSecurity security_;
    haptic_bridge::LinkClock now_;
    std::unique_ptr<haptic_bridge::Client> client_;
    std::uint64_t changes_ = 0;                  // LinkStatus::changes that was printed last
    std::uint32_t loaded_ = 0;                   // LinkStatus::loaded that was reported last
    haptic_bridge::ForceShare share_;            // the whole force until an operator sets it
    ServerTicks ticks_;                          // of all clients
    std::vector<lockstep::Fault> drills_;        // faults that wait for a link
    std::optional<std::uint64_t> trippedTicks_;  // of the last report of this client that had ticks
    std::uint64_t handTicks_ = 0;                // of that report
    bool tripped_ = false;                       // forceTripped()
    // Counters, report and failure of earlier clients.
    haptic_bridge::LinkCounters earlierLinks_;
    std::optional<haptic_bridge::Report> earlierReport_;
    std::string earlierFailure_;
};

}  // namespace master
