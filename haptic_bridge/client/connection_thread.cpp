// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/client/connection_thread.hpp"

#include <fmt/format.h>

#include <boost/asio/post.hpp>
#include <utility>

#include "haptic_bridge/link/link_options.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {

constexpr std::chrono::milliseconds kGoodbye{500};

/// Returns whether `message` may come while no steps are expected: a greeting, or a position of a streaming server.
bool greets(const Message& message, Link link) {
    if (std::holds_alternative<Challenge>(message) || std::holds_alternative<Welcome>(message)) {
        return link < Link::offered || link > Link::streaming;
    }
    return std::holds_alternative<PositionGreeting>(message) ||
           (std::holds_alternative<Position>(message) && link == Link::streaming);
}

}  // namespace

Client::Session::Session(Address address, Offer offer, LinkSecurity security, LinkClock clock)
    : address_(std::move(address)),
      offer_(std::move(offer)),
      security_(std::move(security)),
      now_(clock ? std::move(clock) : host::monotonicNs) {
    backOff_ = kFirstBackOff;
    shelf.tell(Link::connecting, "haptic server " + address_.text() + ": connecting");
    asio::post(io_, [this] { connect(); });
    thread_ = std::thread([this] { run(); });
}

/// Runs until io_ is stopped. An error ends only the link; this thread and the wall continue.
void Client::Session::run() {
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

void Client::Session::stop() {
    if (!thread_.joinable()) {
        return;
    }
    asio::post(io_, [this] {
        stopping_ = true;
        resolver_.cancel();
        retryTimer_.cancel();
        const auto connection = connection_;  // a copy, because a message that was held back may close the connection
        if (connection) {
            connection->resume();
        }
        if (connection_ && handshake_) {  // not during the TLS handshake
            connection_->send(Bye{"the master has ended"});
        }
        goodbyeTimer_.expires_after(connection_ && handshake_ ? kGoodbye : Milliseconds(0));
        goodbyeTimer_.async_wait([this](error_code) { io_.stop(); });
    });
    thread_.join();
    shelf.tell(Link::stopped, "haptic server " + address_.text() + ": link closed");
}

void Client::Session::greet() {
    if (!security_.proves() && !isLoopback(connection_->address())) {
        refuse("is not on this machine: a link over a network needs --secret-file on both sides (docs/security.md)",
               RefusalCode::secret);
        return;
    }
    const Identity mine{kProtocolVersion, sand::kAlgorithmVersion, offer_.rulesDigest, offer_.sceneName};
    handshake_.emplace(security_, mine, Role::move, connection_->binding());
    connection_->send(handshake_->hello());
}

void Client::Session::watch() {
    watchTimer_.expires_after(Milliseconds(500));
    watchTimer_.async_wait([this](error_code error) {
        if (error || !connection_) {
            return;
        }
        const std::int64_t now = now_();
        heardNs_ = shelf.full() ? now : heardNs_;
        if (now - heardNs_ > kSilenceNs) {
            if (!up()) {  // the server accepted the connection and never greeted
                countRefusal(RefusalCode::limit);
            }
            connection_->close(fmt::format("silent for {} s", kSilenceNs / 1'000'000'000));
            return;
        }
        watch();
    });
}

void Client::Session::ping() {
    // Pings are frequent at first, so that the clock offset is known within the first frames.
    pingTimer_.expires_after(pings_ < 8 ? Milliseconds(10) : Milliseconds(250));
    pingTimer_.async_wait([this](error_code error) {
        if (!error && connection_) {
            ++pings_;
            if (!silent()) {
                connection_->send(Ping{host::monotonicNs()});
            }
            ping();
        }
    });
}

void Client::Session::grant(Start start, base::Bytes state, StepRing recent) {
    if (!shelf.beginGranting()) {
        return;
    }
    asio::post(io_, [this, start, grant = Grant(start, std::move(state), std::move(recent))]() mutable {
        if (shelf.link() != Link::granting || !connection_) {
            return;
        }
        grant_ = std::move(grant);
        start.force = force_;
        started_ = true;
        shelf.tell(Link::granting, fmt::format("{}: handing over at step {}", peer_, start.stepNumber));
        connection_->send(start);
    });
}

void Client::Session::shareForce(const ForceShare& share) {
    asio::post(io_, [this, share] {
        force_ = share;
        const Link link = shelf.link();
        if (connection_ && (link == Link::linked || (link == Link::granting && started_))) {
            connection_->send(share);
        }
    });
}

void Client::Session::request(const EditRequest& request) {
    asio::post(io_, [this, request] {
        if (connection_ && shelf.link() == Link::linked) {
            grant_.asked(request.edit);
            connection_->send(request);
        }
    });
}

void Client::Session::receive(Message&& message) {
    heardNs_ = now_();
    shelf.count([this](LinkCounters& counters) {
        counters.bytesIn = connection_->bytesIn();
        counters.bytesOut = connection_->bytesOut();
    });
    const bool ends = std::holds_alternative<Refusal>(message) || std::holds_alternative<Bye>(message);
    if (!handshake_ && !ends) {
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

void Client::Session::take(Link, const Refusal& refusal) {
    shelf.count(
        [code = refusal.code](LinkCounters& counters) { ++counters.refusedHere[static_cast<std::size_t>(code) - 1]; });
    refuse("refuses: " + refusal.text, std::nullopt);
}

void Client::Session::take(Link, const Bye& bye) { connection_->close("it says goodbye: " + bye.reason); }

void Client::Session::take(Link link, const Challenge& challenge) {
    if (isUp(link)) {
        outOfTurn();
    } else if (const auto proof = handshake_->answer(challenge)) {
        connection_->send(*proof);
    } else {
        refuse("refused: " + handshake_->because().text, handshake_->because().code);
    }
}

void Client::Session::take(Link link, const Welcome& greeting) {
    if (isUp(link)) {
        outOfTurn();
        return;
    }
    const Identity mine{kProtocolVersion, sand::kAlgorithmVersion, offer_.rulesDigest, offer_.sceneName};
    // The server compares as well. The client does not rely on that, because the wall must not show other sand than the
    // hand feels.
    if (const auto refusal = refusalFor(greeting.server, mine)) {
        refuse("refused: " + refusal->text, refusal->code);
        return;
    }
    if (!handshake_->accepts(greeting)) {
        refuse("refused: " + handshake_->because().text, handshake_->because().code);
        return;
    }
    connection_->limit(kMaxMessage);
    countLink();
    shelf.setStepsPerSecond(greeting.stepsPerSecond);
    clock_ = ClockOffset();
    shelf.tell(Link::offered, fmt::format("{}: connected, {} steps per second", peer_, greeting.stepsPerSecond));
    ping();
}

void Client::Session::countLink() {
    shelf.linked();
    shelf.count([again = std::exchange(everWelcomed_, true)](LinkCounters& counters) {
        ++counters.links;
        counters.reconnects += again ? 1 : 0;
    });
}

void Client::Session::take(Link, const Pong& pong) {
    clock_.add(pong.masterNs, pong.serverNs, host::monotonicNs());
    shelf.setClockOffset(clock_.offsetNs());
}

void Client::Session::take(Link, const Report& report) { shelf.keep(report); }

void Client::Session::take(Link link, const NeedState& need) {
    if (link != Link::granting || !grant_.mayHandOver()) {
        outOfTurn();
        return;
    }
    const std::vector<Message> answer = grant_.handOver(need);
    const bool whole = std::holds_alternative<State>(answer.front());
    shelf.count([whole](LinkCounters& counters) { ++(whole ? counters.snapshots : counters.catchUps); });
    const auto connection = connection_;  // a copy, because sending may close the connection
    for (const Message& message : answer) {
        connection->send(message);
    }
}

void Client::Session::take(Link link, const Ready&) {
    if (link != Link::granting) {
        outOfTurn();
        return;
    }
    grant_.begun();
    linkedNs_ = host::monotonicNs();
    const Start& start = grant_.start();
    shelf.tell(Link::linked,
               fmt::format("{}: linked, epoch {} from step {}", peer_, start.epoch, start.stepNumber + 1));
}

}  // namespace haptic_bridge
