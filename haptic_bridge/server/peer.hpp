// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>
#include <string>

#include "haptic_bridge/link/connection.hpp"
#include "haptic_bridge/link/silence.hpp"
#include "haptic_bridge/server/roster.hpp"
#include "haptic_bridge/server/service.hpp"

namespace haptic_bridge {

/// The server's end of one connection, from the greeting to the goodbye. Used only by the streaming thread.
class Peer : public std::enable_shared_from_this<Peer> {
public:
    Peer(const Service& service, Gate& gate, Roster<Peer>& roster, Connection::Socket socket);
    void start();

    // Calls for the master's link, from the callbacks of the sand thread.
    void ready();
    void needState(const NeedState& need);
    void unusable(const std::string& why);
    /// `edit` is the number of the edit in the step, or 0.
    void step(base::Bytes message, std::uint64_t edit);
    /// Closes an unauthenticated connection at once.
    void makeRoom();
    /// Sends the last report and a goodbye, then closes. The end of a master's link waits for the audit of the sand, at
    /// most kAuditPatience.
    void sendGoodbye(const std::string& reason);
    void audited(Audited result);
    /// Says goodbye while the server reads its scene. A peer without a reason of its own greets again.
    void endLoading(const std::string& why = "its scene is read");

    [[nodiscard]] std::uint32_t session() const { return session_; }
    [[nodiscard]] boost::asio::ip::address address() const { return connection_->address(); }
    [[nodiscard]] std::weak_ptr<Connection> connection() const { return connection_; }

private:
    enum class Phase { greeting, proving, waiting, granting, linked, leaving, loading, watching, over };

    void receive(Message&& message);
    void take(const Hello& hello);
    void take(const Proof& proof);
    void take(const Ping& ping);
    void take(const Bye& bye);
    void take(const StartMessage& start);
    void take(State& state);
    void take(CatchUp& catchUp);
    void take(const Shown& shown);
    void take(const TimingEcho& echo);
    void take(EditRequest& request);
    void take(const ForceShare& force);
    template <class Other>
    void take(const Other&) {
        outOfTurn();
    }
    void welcome();
    void refuse(const Refusal& refusal);
    void outOfTurn();
    void close(Audited result);
    void end(const std::string& why, Connection::Fault fault = std::nullopt);
    void sendTicks(bool all);
    void tickReport();
    void tickLoading();
    void tickTimingTest(double pause /* [s] */ = 0);
    void watch();
    void log(const std::string& what) const;
    [[nodiscard]] Report report() const;

    // A master waits half a second for the last report (Client::stop()).
    static constexpr std::chrono::milliseconds kAuditPatience{400};

    const Service& service_;
    Gate& gate_;
    Roster<Peer>& roster_;
    std::shared_ptr<Connection> connection_;
    boost::asio::steady_timer reportTimer_, testTimer_, watchTimer_;
    ServerHandshake handshake_;
    Role role_ = Role::move;
    std::string scene_;
    Phase phase_ = Phase::greeting;
    std::uint32_t session_ = 0;
    struct Grant {
        std::uint32_t epoch = 0;
        std::uint64_t firstStep = 0;
        std::size_t catchUpsLeft = 0;  // CatchUps that may still come
        bool askedForSteps = false;
        std::uint64_t longLoad = 0;  // number of the long load that waits for its step; 0: none waits
    } grant_;
    struct Sent {
        std::uint64_t steps = 0, bytes = 0;
        std::size_t lastBytes = 0;
    } sent_;  // counts of step messages
    RoundTrips roundTrips_;
    std::string goodbye_;  // reason of the goodbye that is to be sent
    Silence silence_;      // of the peer; before it is authenticated, since start()
};

}  // namespace haptic_bridge
