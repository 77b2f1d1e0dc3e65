// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/client/connection_thread.hpp"

#include <fmt/format.h>

#include <boost/asio/post.hpp>
#include <utility>

#include "host/clock.hpp"

namespace haptic_bridge {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {

constexpr std::chrono::milliseconds kGoodbye{500};
constexpr double kLoadingRate = 20;  // [message/s] of a server that reads its scene; it sends two

/// Returns whether `message` may come while no steps are expected: a greeting, or a position of a streaming server.
bool greets(const Message& message, Link link) {
    if (std::holds_alternative<Challenge>(message) || std::holds_alternative<Welcome>(message) ||
        std::holds_alternative<Loading>(message)) {
        return link < Link::offered || link > Link::streaming;
    }
    return std::holds_alternative<PositionGreeting>(message) ||
           (std::holds_alternative<Pong>(message) && link == Link::loading) ||
           (std::holds_alternative<Position>(message) && link == Link::streaming);
}

}  // namespace

Client::Conversation::Conversation(Address address, Offer offer, LinkSecurity security, LinkClock clock)
    : address_(std::move(address)),
      limits_(offer.limits),
      greeter_(std::move(offer), std::move(security)),
      silence_(io_, clock ? std::move(clock) : host::monotonicNs) {
    shelf.setStatus(Link::connecting, peer() + ": connecting");
    asio::post(io_, [this] { connect(); });
    thread_ = std::thread([this] { run(); });
}

/// Runs until io_ is stopped. An error ends only the link; this thread and the wall continue.
void Client::Conversation::run() {
    const auto work = asio::make_work_guard(io_);
    while (!io_.stopped()) {
        try {
            io_.run();
        } catch (const std::exception& error) {
            asio::post(io_, [this, why = std::string(error.what())] {
                if (connection_) {
                    connection_->close(why);
                } else if (!stopping_) {
                    failed(why);
                }
            });
        }
    }
}

void Client::Conversation::stop() {
    if (!thread_.joinable()) {
        return;
    }
    asio::post(io_, [this] {
        stopping_ = true;
        connector_.cancel();
        retryPause_.cancel();
        const auto connection = connection_;  // a copy, because a message that was held back may close the connection
        if (connection) {
            connection->resume();
        }
        const bool greeted = connection_ && greeter_.greeted();  // false during the TLS handshake
        if (greeted) {
            connection_->send(Bye{"the master has ended"});
        }
        goodbyeTimer_.expires_after(greeted && connection_ ? kGoodbye : std::chrono::milliseconds(0));
        goodbyeTimer_.async_wait([this](error_code) { io_.stop(); });
    });
    thread_.join();
    shelf.setStatus(Link::stopped, peer() + ": link closed");
}

void Client::Conversation::greet() {
    if (!greeter_.greets(connection_->address())) {
        refuse("is not on this machine: a link over a network needs --secret-file on both sides (docs/security.md)",
               RefusalCode::secret);
        return;
    }
    connection_->send(greeter_.greet(connection_->binding()));
}

/// Ends the link, because the server has been silent for too long.
void Client::Conversation::fallSilent() {
    if (!up() && shelf.link() != Link::loading) {  // the server accepted the connection and never greeted
        countRefusal(RefusalCode::limit);
    }
    connection_->close(fmt::format("{} for {} s",
                                   shelf.link() == Link::loading ? "its scene gets no further" : "silent",
                                   silence_.most() / 1'000'000'000));
}

void Client::Conversation::grant(StartMessage start, StepRing recent) {
    if (!shelf.beginGranting()) {
        return;
    }
    asio::post(io_, [this, start, grant = Grant(start, std::move(recent))]() mutable {
        if (shelf.link() != Link::granting || !connection_) {
            return;
        }
        grant_ = std::move(grant);
        start.force = force_;
        shelf.setStatus(Link::granting, fmt::format("{}: handing over at step {}", peer(), start.stepNumber));
        connection_->send(start);
    });
}

void Client::Conversation::giveState(base::Bytes state) {
    if (!shelf.beginGivingState()) {
        return;
    }
    asio::post(io_, [this, state = std::move(state)]() mutable {
        // The connection may have ended, and the next one may be granted already.
        if (connection_ && grant_ && grant_->awaitsState() && shelf.link() == Link::granting) {
            grant_->stateGiven();
            shelf.count([](LinkCounters& counters) { ++counters.snapshots; });
            connection_->send(State{std::move(state)});
        }
    });
}

void Client::Conversation::shareForce(const ForceShare& share) {
    asio::post(io_, [this, share] {
        force_ = share;
        const Link link = shelf.link();
        if (connection_ && grant_ && (link == Link::linked || link == Link::granting)) {
            connection_->send(share);
        }
    });
}

void Client::Conversation::request(const EditRequest& request) {
    asio::post(io_, [this, request] {
        if (connection_ && shelf.link() == Link::linked) {
            grant_->asked(request.edit);
            connection_->send(request);
        }
    });
}

void Client::Conversation::receive(Message&& message) {
    if (shelf.link() != Link::loading) {  // there only progress counts
        silence_.heard();
    }
    shelf.count([this](LinkCounters& counters) {
        counters.bytesIn = connection_->bytesIn();
        counters.bytesOut = connection_->bytesOut();
    });
    const bool ends = std::holds_alternative<Refusal>(message) || std::holds_alternative<Bye>(message);
    if (!greeter_.greeted() && !ends) {
        outOfTurn();
        return;
    }
    const Link link = shelf.link();
    const bool welcomed = link >= Link::offered && link <= Link::linked;
    if (!ends && !welcomed && !greets(message, link)) {
        connection_->close("it sent another message than a greeting", RefusalCode::garbage);
        return;
    }
    std::visit([this, link](auto& kind) { take(link, kind); }, message);
}

void Client::Conversation::take(Link, const Refusal& refusal) {
    shelf.count(
        [code = refusal.code](LinkCounters& counters) { ++counters.refusedHere[static_cast<std::size_t>(code) - 1]; });
    refuse("refuses: " + refusal.text, std::nullopt);
}

void Client::Conversation::take(Link, const Bye& bye) { connection_->close("it says goodbye: " + bye.reason); }

void Client::Conversation::take(Link link, const Challenge& challenge) {
    if (isUp(link)) {
        outOfTurn();
    } else if (const auto proof = greeter_.answer(challenge)) {
        connection_->send(*proof);
    } else {
        refuse("refused: " + greeter_.because().text, greeter_.because().code);
    }
}

void Client::Conversation::take(Link link, const Welcome& greeting) {
    if (isUp(link)) {
        outOfTurn();
        return;
    }
    if (const auto refusal = greeter_.refusalOf(greeting)) {
        refuse("refused: " + refusal->text, refusal->code);
        return;
    }
    connection_->limit(kMaxMessage);
    connection_->setRate(Connection::kMaxRate);
    silence_.setMost(kSilenceNs);
    countLink();
    shelf.setStepsPerSecond(greeting.stepsPerSecond);
    shelf.setStatus(Link::offered, fmt::format("{}: connected, {} steps per second", peer(), greeting.stepsPerSecond));
    startPings();
}

void Client::Conversation::take(Link link, const Loading& loading) {
    if (isUp(link)) {
        outOfTurn();
        return;
    }
    if (link != Link::loading) {
        if (!greeter_.accepts(loading)) {
            refuse("refused: " + greeter_.because().text, greeter_.because().code);
            return;
        }
        connection_->setRate(kLoadingRate);
        silence_.heard();
        silence_.setMost(kLoadingNs);
        retryPause_.linked(host::monotonicNs());
        shelf.setLoaded(0);
        shelf.setStatus(Link::loading, peer() + ": reads its scene");
        startPings();
    }
    if (loading.done >= loaded_ + Loading::kAll / 100) {
        loaded_ = loading.done;
        silence_.heard();
        shelf.setLoaded(loaded_);
    }
}

void Client::Conversation::startPings() {
    pings_.start([this] {
        if (!drill_.active()) {
            connection_->send(Ping{host::monotonicNs()});
        }
    });
}

void Client::Conversation::countLink() {
    shelf.linked();
    shelf.count([](LinkCounters& counters) {
        counters.reconnects += counters.links > 0 ? 1 : 0;
        ++counters.links;
    });
}

void Client::Conversation::take(Link, const Pong& pong) {
    shelf.setClockOffset(pings_.answered(pong, host::monotonicNs()));
}

void Client::Conversation::take(Link, const Report& report) { shelf.keep(report); }

void Client::Conversation::take(Link link, const NeedState& need) {
    if (link != Link::granting || !grant_ || !grant_->mayHandOver()) {
        outOfTurn();
        return;
    }
    const std::vector<CatchUp> answer = grant_->catchUps(need);
    if (answer.empty()) {
        shelf.askForState();
        return;
    }
    shelf.count([](LinkCounters& counters) { ++counters.catchUps; });
    const auto connection = connection_;  // a copy, because sending may close the connection
    for (const CatchUp& steps : answer) {
        connection->send(steps);
    }
}

void Client::Conversation::take(Link link, const Ready& ready) {
    if (link != Link::granting || !grant_) {
        outOfTurn();
        return;
    }
    grant_->begun();
    shelf.setForceCeiling(ready.forceCeiling);
    retryPause_.linked(host::monotonicNs());
    const StartMessage& start = grant_->start();
    shelf.setStatus(Link::linked,
                    fmt::format("{}: linked, epoch {} from step {}", peer(), start.epoch, start.stepNumber + 1));
}

}  // namespace haptic_bridge
