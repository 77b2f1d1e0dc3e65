// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/client/connection_thread.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

#include "haptic_bridge/link/link_options.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {

constexpr std::chrono::milliseconds kGoodbye{500};
constexpr std::size_t kMaxTickPieces = 4096;  // half an hour of them; a session that keeps none takes none out

}  // namespace

Client::Session::Session(Address address, Offer offer, LinkSecurity security, LinkClock clock)
    : address_(std::move(address)),
      offer_(std::move(offer)),
      security_(std::move(security)),
      now_(clock ? std::move(clock) : host::monotonicNs) {
    backOff_ = kFirstBackOff;
    tell(Link::connecting, "haptic server " + address_.text() + ": connecting");
    asio::post(io_, [this] { connect(); });
    thread_ = std::thread([this] { run(); });
}

/// Until io_ is stopped: whatever goes wrong costs the link, and neither this thread nor the wall.
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
        const auto connection = connection_;  // what was held back may close it
        if (connection) {
            connection->resume();
        }
        if (connection_ && handshake_) {  // not in the middle of agreeing on TLS
            connection_->send(Bye{"the master has ended"});
        }
        goodbyeTimer_.expires_after(connection_ && handshake_ ? kGoodbye : Milliseconds(0));
        goodbyeTimer_.async_wait([this](error_code) { io_.stop(); });
    });
    thread_.join();
    tell(Link::stopped, "haptic server " + address_.text() + ": link closed");
}

void Client::Session::tell(Link link, const std::string& message) {
    const std::lock_guard lock(shelf.mutex);
    if (shelf.status.changes == 0 || shelf.status.link != link || shelf.status.message != message) {
        shelf.status = {link, message, shelf.status.changes + 1};
    }
}

Link Client::Session::link() {
    const std::lock_guard lock(shelf.mutex);
    return shelf.status.link;
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

void Client::Session::prove(const Challenge& challenge) {
    if (const auto proof = handshake_->answer(challenge)) {
        connection_->send(*proof);
    } else {
        refuse("refused: " + handshake_->because().text, handshake_->because().code);
    }
}

void Client::Session::watch() {
    watchTimer_.expires_after(Milliseconds(500));
    watchTimer_.async_wait([this](error_code error) {
        if (error || !connection_) {
            return;
        }
        bool full = false;
        {
            const std::lock_guard lock(shelf.mutex);
            full = shelf.full;
        }
        const std::int64_t now = now_();
        heardNs_ = full ? now : heardNs_;
        if (now - heardNs_ > kSilenceNs) {
            if (!up()) {  // it accepted the connection and never greeted
                countRefusal(RefusalCode::limit);
            }
            connection_->close(fmt::format("silent for {} s", kSilenceNs / 1'000'000'000));
            return;
        }
        watch();
    });
}

void Client::Session::ping() {
    // Quick at first, so that the clock offset is known within the first frames.
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
    {
        const std::lock_guard lock(shelf.mutex);
        if (shelf.status.link != Link::offered) {
            return;
        }
        // Now, and not when the network thread comes to it: who polls again meanwhile must not see an offer.
        shelf.status.link = Link::granting;
        shelf.steps.clear();
    }
    asio::post(io_, [this, start, state = std::move(state), recent = std::move(recent)]() mutable {
        if (link() != Link::granting || !connection_) {
            return;
        }
        granted_ = start;
        lastStep_ = start.stepNumber;
        state_ = std::move(state);
        recent_ = std::move(recent);
        handOvers_ = 0;
        tell(Link::granting, fmt::format("{}: handing over at step {}", peer_, start.stepNumber));
        connection_->send(start);
    });
}

void Client::Session::shareForce(double share) {
    asio::post(io_, [this, share] {
        if (connection_ && link() == Link::linked) {
            connection_->send(ForceShare{share});
        }
    });
}

void Client::Session::request(const EditRequest& request) {
    asio::post(io_, [this, request] {
        if (connection_ && link() == Link::linked) {
            connection_->expectLoads(request.edit.kind == sand::Edit::load);  // it comes back in a step
            connection_->send(request);
        }
    });
}

void Client::Session::receive(Message&& message) {
    heardNs_ = now_();
    {
        const std::lock_guard lock(shelf.mutex);
        shelf.counters.bytesIn = connection_->bytesIn();
        shelf.counters.bytesOut = connection_->bytesOut();
    }
    if (const auto* refusal = std::get_if<Refusal>(&message)) {
        {
            const std::lock_guard lock(shelf.mutex);
            ++shelf.counters.refusedHere[static_cast<std::size_t>(refusal->code) - 1];
        }
        refuse("refuses: " + refusal->text, std::nullopt);
    } else if (const auto* bye = std::get_if<Bye>(&message)) {
        connection_->close("it says goodbye: " + bye->reason);
    } else if (!handshake_) {
        connection_->close("it sent a message out of turn", RefusalCode::garbage);
    } else if (const auto* challenge = std::get_if<Challenge>(&message); challenge != nullptr && !up()) {
        prove(*challenge);
    } else if (const auto* greeting = std::get_if<Welcome>(&message); greeting != nullptr && !up()) {
        welcome(*greeting);
    } else if (const auto* positions = std::get_if<PositionGreeting>(&message)) {
        greet(*positions);
    } else if (const auto* position = std::get_if<Position>(&message); position && link() == Link::streaming) {
        accept(*position);
    } else if (link() < Link::offered || link() > Link::linked) {
        connection_->close("it did not greet", RefusalCode::garbage);
    } else if (const auto* pong = std::get_if<Pong>(&message)) {
        clock_.add(pong->masterNs, pong->serverNs, host::monotonicNs());
        const std::lock_guard lock(shelf.mutex);
        shelf.clockOffsetNs = clock_.offsetNs();
    } else if (const auto* report = std::get_if<Report>(&message)) {
        const std::lock_guard lock(shelf.mutex);
        shelf.report = *report;
    } else if (const auto* test = std::get_if<TimingTest>(&message)) {
        accept(*test);
    } else if (auto* step = std::get_if<StepMessage>(&message)) {
        accept(std::move(*step));
    } else if (auto* piece = std::get_if<TickPiece>(&message)) {
        const std::lock_guard lock(shelf.mutex);
        if (shelf.ticks.size() < kMaxTickPieces) {
            shelf.ticks.push_back(std::move(piece->bytes));
        }
    } else if (const auto* need = std::get_if<NeedState>(&message);
               need != nullptr && link() == Link::granting && handOvers_ < 2) {
        handOver(*need);
    } else if (std::holds_alternative<Ready>(message) && link() == Link::granting) {
        state_ = {};
        recent_ = {};
        backOff_ = kFirstBackOff;
        tell(Link::linked,
             fmt::format("{}: linked, epoch {} from step {}", peer_, granted_.epoch, granted_.stepNumber + 1));
    } else {
        connection_->close("it sent a message out of turn", RefusalCode::garbage);
    }
}

/// By the steps that the server lacks, where those are known; by all of the sand else, or when it asks again.
void Client::Session::handOver(const NeedState& need) {
    const auto steps = handOvers_++ == 0 ? recent_.since(need, granted_.stepNumber) : std::nullopt;
    {
        const std::lock_guard lock(shelf.mutex);
        ++(steps ? shelf.counters.catchUps : shelf.counters.snapshots);
    }
    if (!steps) {
        handOvers_ = 2;
        connection_->send(State{std::exchange(state_, {})});
        return;
    }
    const auto connection = connection_;  // sending may close it
    for (std::size_t begin = 0; begin < steps->size(); begin += kMaxCatchUp) {
        const std::size_t end = std::min(begin + kMaxCatchUp, steps->size());
        const auto at = [&](std::size_t i) { return steps->begin() + static_cast<std::ptrdiff_t>(i); };
        connection->send(CatchUp{end == steps->size(), {at(begin), at(end)}});
    }
}

void Client::Session::welcome(const Welcome& greeting) {
    const Identity mine{kProtocolVersion, sand::kAlgorithmVersion, offer_.rulesDigest, offer_.sceneName};
    // The server judged as well; a server that does not is no reason to show sand that differs from what is felt.
    if (const auto refusal = refusalFor(greeting.server, mine)) {
        refuse("refused: " + refusal->text, refusal->code);
        return;
    }
    if (!handshake_->accepts(greeting)) {
        refuse("refused: " + handshake_->because().text, handshake_->because().code);
        return;
    }
    connection_->limit(kMaxMessage);
    {
        const std::lock_guard lock(shelf.mutex);
        ++shelf.counters.links;
        shelf.counters.reconnects += everWelcomed_ ? 1 : 0;
        shelf.stepsPerSecond = greeting.stepsPerSecond;
    }
    everWelcomed_ = true;
    clock_ = ClockOffset();
    tell(Link::offered, fmt::format("{}: connected, {} steps per second", peer_, greeting.stepsPerSecond));
    ping();
}

}  // namespace haptic_bridge
