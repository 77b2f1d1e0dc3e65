// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "haptic_bridge/client/connector.hpp"
#include "haptic_bridge/client/grant.hpp"
#include "haptic_bridge/client/greeter.hpp"
#include "haptic_bridge/client/link_timers.hpp"
#include "haptic_bridge/client/shelf.hpp"
#include "haptic_bridge/link/connection.hpp"

namespace haptic_bridge {

/// Implementation of Client. Its network thread runs the whole conversation, and puts the results on the shelf for the
/// callers.
class Client::Conversation {
public:
    Conversation(Address address, Offer offer, LinkSecurity security, LinkClock clock);
    ~Conversation() { stop(); }
    Conversation(const Conversation&) = delete;
    Conversation& operator=(const Conversation&) = delete;

    // These functions may be called by any thread.
    void grant(StartMessage start, StepRing recent);
    void giveState(base::Bytes state);
    std::vector<TimedStep> drain(std::size_t most);
    void shown(const Shown& frame);
    void request(const EditRequest& request);
    void shareForce(const ForceShare& share);
    void drill(LinkDrill drill, std::chrono::milliseconds length);
    std::vector<TimedPosition> drainPositions();
    void stop();

    Shelf shelf;

private:
    void run();
    void connect();
    void connected(Connection::Socket socket);
    void failed(const std::string& why);
    void closed(const std::string& why);
    void greet();
    void refuse(const std::string& why, Connection::Fault fault);
    void countRefusal(RefusalCode code);
    void countLink();
    void startPings();
    void retry();
    void fallSilent();
    [[nodiscard]] std::string peer() const { return "haptic server " + address_.text(); }
    [[nodiscard]] bool up() const { return isUp(shelf.link()); }
    [[nodiscard]] static bool isUp(Link link) { return link >= Link::offered && link <= Link::streaming; }
    void resumeReading();

    void receive(Message&& message);
    void outOfTurn() { connection_->close("it sent a message out of turn", RefusalCode::garbage); }
    // Handlers of the server's messages. `link` is the state of the link when the message came.
    void take(Link link, const Refusal& refusal);
    void take(Link link, const Bye& bye);
    void take(Link link, const Challenge& challenge);
    void take(Link link, const Welcome& welcome);
    void take(Link link, const Loading& loading);
    void take(Link link, const Pong& pong);
    void take(Link link, const Report& report);
    void take(Link link, const TimingTest& test);
    void take(Link link, StepMessage& message);
    void take(Link link, TickPiece& piece);
    void take(Link link, const NeedState& need);
    void take(Link link, const Ready& ready);
    void take(Link link, const PositionGreeting& greeting);
    void take(Link link, const Position& position);
    template <class Other>
    void take(Link, const Other&) {
        outOfTurn();
    }

    const Address address_;
    const sand::StepLimits limits_;
    Greeter greeter_;
    boost::asio::io_context io_;
    Connector connector_{io_};
    RetryPause retryPause_{io_};
    SilenceWatch silence_;
    Pings pings_{io_};
    SilenceDrill drill_{io_};
    // A timer of its own, because a handler of another timer that is already due must not delay the end.
    boost::asio::steady_timer goodbyeTimer_{io_};
    std::shared_ptr<Connection> connection_;
    std::optional<Grant> grant_;  // of this connection; nullopt before its Start
    ForceShare force_;            // of the next Start
    std::uint32_t loaded_ = 0;    // last part of the scene that counted as progress on this connection
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace haptic_bridge
