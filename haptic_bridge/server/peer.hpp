// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <map>
#include <random>

#include "haptic_bridge/server/listener.hpp"

namespace haptic_bridge {

/// The server's end of one connection, from the greeting to the goodbye. On the streaming thread alone.
class Peer : public std::enable_shared_from_this<Peer> {
public:
    Peer(Listener& listener, Connection::Socket socket);
    void start();

    void ready();
    void needState(const NeedState& need);
    void unusable(const std::string& why);
    void step(base::Bytes message);
    /// Of a guest: ends at once.
    void makeRoom();
    /// Sends the last report and a goodbye, then closes.
    void sayGoodbye(const std::string& reason);

    [[nodiscard]] std::uint32_t session() const { return session_; }
    [[nodiscard]] boost::asio::ip::address address() const { return connection_->address(); }
    [[nodiscard]] std::weak_ptr<Connection> connection() const { return connection_; }

private:
    enum class Phase { greeting, proving, waiting, granting, linked, watching, over };

    void receive(Message&& message);
    void receiveLinked(Message&& message);
    void greet(const Hello& hello);
    void judge(const Proof& proof);
    void welcome();
    void watchStep(const base::Bytes& message);
    void echoed(const TimingEcho& echo);
    void refuse(const Refusal& refusal);
    void outOfTurn();
    void end(const std::string& why, Connection::Fault fault = std::nullopt);
    void sendTicks(bool all);
    void tickReport();
    void tickTimingTest(double pause /* [s] */ = 0);
    void watch();
    void log(const std::string& what) const;
    [[nodiscard]] Report report() const;

    Listener& listener_;
    std::shared_ptr<Connection> connection_;
    boost::asio::steady_timer reportTimer_, testTimer_, watchTimer_;
    ServerHandshake handshake_;
    Role role_ = Role::move;
    std::string scene_;
    Phase phase_ = Phase::greeting;
    std::uint32_t session_ = 0;
    std::uint32_t epoch_ = 0;
    std::uint64_t firstStep_ = 0;
    std::size_t catchUpsLeft_ = 0;  // that may still come
    bool askedForSteps_ = false;
    std::int64_t heardNs_ = 0;
    std::uint64_t steps_ = 0, stepBytes_ = 0;
    std::size_t lastStepBytes_ = 0;
    std::uint32_t lastTest_ = 0;
    struct TestOut {
        std::int64_t sentNs = 0;
        bool received = false;
    };
    std::map<std::uint32_t, TestOut> testsOut_;  // by id
    base::LiveHistogram toWall_, toMaster_;      // half of the round trips
    std::minstd_rand random_;
};

}  // namespace haptic_bridge
