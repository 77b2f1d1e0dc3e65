// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <random>

#include "haptic_bridge/link_server.hpp"

namespace haptic_bridge {

/// The server's end of one connection, from the greeting to the goodbye. On the streaming thread alone.
class MasterLink : public std::enable_shared_from_this<MasterLink> {
public:
    MasterLink(LinkServer& server, Connection::Socket socket);
    void start();

    void ready();
    void needState();
    void unusable(const std::string& why);
    void step(files::Bytes message);
    /// Sends the last report and a goodbye, then closes.
    void sayGoodbye(const std::string& reason);

    [[nodiscard]] std::uint32_t session() const { return session_; }
    [[nodiscard]] std::weak_ptr<Connection> connection() const { return connection_; }

private:
    enum class Phase { greeting, waiting, granting, linked, over };

    void receive(Message&& message);
    void greet(const Hello& hello);
    void echoed(std::uint32_t id);
    void refuse(const Refusal& refusal);
    void outOfTurn();
    void end(const std::string& why);
    void tickReport();
    void tickTimingTest();
    void watch();
    void log(const std::string& what) const;
    [[nodiscard]] Report report() const;

    LinkServer& server_;
    std::shared_ptr<Connection> connection_;
    boost::asio::steady_timer reportTimer_, testTimer_, watchTimer_;
    Phase phase_ = Phase::greeting;
    std::uint32_t session_ = 0;
    std::uint32_t epoch_ = 0;
    std::uint64_t firstStep_ = 0;
    std::int64_t heardNs_ = 0;
    std::uint64_t steps_ = 0, stepBytes_ = 0;
    std::size_t lastStepBytes_ = 0;
    std::uint32_t lastTest_ = 0;
    std::map<std::uint32_t, std::int64_t> testsOut_;  // by id: when sent [ns]
    LiveHistogram halfRoundTrip_;
    // Random, so that tests do not beat with frames; seeded, because nothing in a session should differ by chance.
    std::minstd_rand random_{7};
};

}  // namespace haptic_bridge
