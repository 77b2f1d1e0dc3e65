// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/peer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "haptic_bridge/link/step_ring.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {

using boost::system::error_code;
using std::chrono::milliseconds;

namespace {

constexpr std::int64_t kGreetingNs = 3'000'000'000;  // a guest must greet within
constexpr std::int64_t kSilenceNs = 10'000'000'000;  // a master pings four times a second
constexpr std::size_t kMaxTestsOut = 64;
constexpr std::uint64_t kMaxGuestBytes = 16 * 1024;  // a greeting takes some hundred, TLS some hundred more
constexpr double kWatcherRate = 50;                  // [1/s]; it has nothing to say but four pings
constexpr std::size_t kWatcherUnsent = 256 * 1024;   // [byte]; about half a minute of steps

/// One more of `count` for so long as it lives.
std::shared_ptr<Connection> counted(std::unique_ptr<Connection> connection, const std::shared_ptr<int>& count) {
    ++*count;
    return {connection.release(), [count](Connection* gone) {
                delete gone;
                --*count;
            }};
}

HalfRoundTrip told(const base::LiveHistogram& halves) {
    return {halves.meanNs() * 1e-6, halves.stddevNs() * 1e-6, halves.percentileNs(0.50) * 1e-6,
            halves.percentileNs(0.99) * 1e-6, halves.count()};
}

}  // namespace

Peer::Peer(Listener& listener, Connection::Socket socket)
    : listener_(listener),
      connection_(counted(std::make_unique<Connection>(
                              std::move(socket), listener.security_.tls ? listener.security_.tls->open() : nullptr),
                          listener.connections_)),
      reportTimer_(listener.io_),
      testTimer_(listener.io_),
      watchTimer_(listener.io_),
      handshake_(listener.security_),
      random_(listener.tests_.seed) {}

void Peer::start() {
    heardNs_ = host::monotonicNs();
    connection_->limit(kMaxGreeting);
    connection_->setMaxIn(kMaxGuestBytes);
    if (*listener_.connections_ > Listener::kMaxConnections / 2) {
        connection_->setLinger(milliseconds(0));  // no place is kept for who is refused
    }
    connection_->start(
        {[self = shared_from_this()](Message&& message) { self->receive(std::move(message)); },
         [self = shared_from_this()](const std::string& why, Connection::Fault fault) { self->end(why, fault); },
         true});
    watch();
}

void Peer::makeRoom() {
    const auto kept = shared_from_this();
    connection_->close("others wait, and it has not greeted yet", RefusalCode::limit);
}

void Peer::log(const std::string& what) const {
    listener_.sources_.log(
        fmt::format("{} {}: {}", role_ == Role::move ? "master" : "watcher", connection_->peer(), what));
}

void Peer::watch() {
    watchTimer_.expires_after(milliseconds(500));
    watchTimer_.async_wait([self = shared_from_this()](error_code error) {
        if (error || self->phase_ == Phase::over) {
            return;
        }
        const std::int64_t silence = host::monotonicNs() - self->heardNs_;
        const std::int64_t most = self->phase_ <= Phase::proving ? kGreetingNs : kSilenceNs;
        if (silence > most) {
            self->connection_->close(
                fmt::format("silent for {} s", most / 1'000'000'000),
                self->phase_ <= Phase::proving ? Connection::Fault(RefusalCode::limit) : std::nullopt);
            return;
        }
        self->watch();
    });
}

void Peer::receive(Message&& message) {
    if (phase_ == Phase::over) {
        return;
    }
    heardNs_ = phase_ <= Phase::proving ? heardNs_ : host::monotonicNs();
    if (phase_ == Phase::greeting) {
        const auto* hello = std::get_if<Hello>(&message);
        hello != nullptr ? greet(*hello) : outOfTurn();
    } else if (phase_ == Phase::proving) {
        const auto* proof = std::get_if<Proof>(&message);
        proof != nullptr ? judge(*proof) : outOfTurn();
    } else if (const auto* ping = std::get_if<Ping>(&message)) {
        connection_->send(Pong{ping->masterNs, host::monotonicNs()});
    } else if (std::holds_alternative<Bye>(message)) {
        sayGoodbye(role_ == Role::move ? "the master has said goodbye" : "the watcher has said goodbye");
    } else if (phase_ == Phase::watching) {
        refuse({RefusalCode::role, "who watches only listens; that takes the secret of role move"});
    } else {
        receiveLinked(std::move(message));
    }
}

void Peer::receiveLinked(Message&& message) {
    if (const auto* start = std::get_if<Start>(&message); start != nullptr && phase_ == Phase::waiting) {
        phase_ = Phase::granting;
        epoch_ = start->epoch;
        firstStep_ = start->stepNumber + 1;
        listener_.sandThread_->start(session_, *start);
    } else if (auto* state = std::get_if<State>(&message); state != nullptr && phase_ == Phase::granting) {
        listener_.sandThread_->state(std::move(state->bytes));
    } else if (auto* catchUp = std::get_if<CatchUp>(&message);
               catchUp != nullptr && phase_ == Phase::granting && catchUpsLeft_ > 0) {
        catchUpsLeft_ = catchUp->last ? 0 : catchUpsLeft_ - 1;
        listener_.sandThread_->catchUp(std::move(*catchUp));
    } else if (const auto* shown = std::get_if<Shown>(&message); shown != nullptr && phase_ == Phase::linked) {
        if (shown->stepNumber + 1 > firstStep_ + steps_) {
            connection_->close(fmt::format("it claims to show step {}, which was not sent", shown->stepNumber),
                               RefusalCode::garbage);
            return;
        }
        listener_.sandThread_->shown(*shown, host::monotonicNs());
    } else if (const auto* echo = std::get_if<TimingEcho>(&message); echo != nullptr && phase_ == Phase::linked) {
        echoed(*echo);
    } else if (auto* request = std::get_if<EditRequest>(&message); request != nullptr && phase_ == Phase::linked) {
        connection_->expectLoads(request->edit.kind != sand::Edit::load);  // one at a time: until it is in a step
        listener_.sandThread_->edit(std::move(*request));
    } else if (const auto* force = std::get_if<ForceShare>(&message); force != nullptr && phase_ == Phase::linked) {
        if (listener_.sources_.shareForce) {
            listener_.sources_.shareForce(force->share);
        }
    } else {
        outOfTurn();
    }
}

void Peer::greet(const Hello& hello) {
    // A watcher has no sand that could differ.
    const bool versionAlone = hello.role == Role::watch && hello.master.protocol == kProtocolVersion;
    if (const auto refusal = versionAlone ? std::nullopt : refusalFor(listener_.identity_, hello.master)) {
        refuse(*refusal);
        return;
    }
    if (const auto refusal = handshake_.refusalFor(hello, connection_->overTls())) {
        refuse(*refusal);
        return;
    }
    role_ = hello.role;
    scene_ = hello.master.sceneName;
    if (const auto challenge = handshake_.challenge(hello, listener_.identity_, connection_->binding())) {
        phase_ = Phase::proving;
        connection_->send(*challenge);
    } else {
        welcome();
    }
}

void Peer::judge(const Proof& proof) {
    if (!handshake_.accepts(proof)) {
        refuse({RefusalCode::secret,
                fmt::format("the secret of role {} is another here; give both sides the same --secret-file",
                            nameOf(role_))});
        return;
    }
    welcome();
}

/// Only now is it told who else is here: before, nobody knows who asks.
void Peer::welcome() {
    if (role_ == Role::move && listener_.current_) {
        refuse({RefusalCode::busy, fmt::format("busy: the master at {} is linked; one wall at a time",
                                               listener_.current_->connection_->peer())});
        return;
    }
    if (role_ == Role::watch && listener_.watchers_.size() >= Listener::kMaxWatchers) {
        refuse({RefusalCode::busy, fmt::format("busy: {} watch already", Listener::kMaxWatchers)});
        return;
    }
    listener_.guestWent(*this);
    connection_->setMaxIn(std::numeric_limits<std::uint64_t>::max());
    connection_->setLinger(Connection::kLinger);
    if (role_ == Role::move) {
        phase_ = Phase::waiting;
        session_ = ++listener_.sessions_;
        listener_.current_ = shared_from_this();
        connection_->limit(kMaxMessage);
    } else {
        phase_ = Phase::watching;
        listener_.watchers_.insert(shared_from_this());
        connection_->setRate(kWatcherRate);
        connection_->setMaxUnsent(kWatcherUnsent);
    }
    connection_->send(Welcome{listener_.identity_, listener_.stepsPerSecond_, role_, handshake_.mac()});
    if (role_ == Role::move) {
        log(fmt::format("welcome, scene '{}'{}{}", scene_, listener_.security_.proves() ? ", secret proved" : "",
                        connection_->overTls() ? ", TLS 1.3" : ""));
    }
    tickReport();
}

void Peer::refuse(const Refusal& refusal) {
    connection_->send(refusal);
    const auto kept = connection_;
    end("refused: " + refusal.text, refusal.code);
    kept->finish();
}

void Peer::outOfTurn() { refuse({RefusalCode::garbage, "that message was out of turn"}); }

void Peer::ready() {
    phase_ = Phase::linked;
    connection_->expectState(false);
    connection_->expectLoads(true);
    log(fmt::format("linked, epoch {} from step {}", epoch_, firstStep_));
    connection_->send(Ready{});
    tickTimingTest(listener_.tests_.after);
}

void Peer::needState(const NeedState& need) {
    connection_->expectState(true);
    // By steps at the first time alone; then it is the whole sand.
    catchUpsLeft_ = std::exchange(askedForSteps_, true) ? 0 : StepRing::kSteps / kMaxCatchUp;
    connection_->send(need);
}

void Peer::unusable(const std::string& why) { refuse({RefusalCode::state, why}); }

void Peer::sendTicks(bool all) {
    if (!listener_.sources_.ticks) {
        return;
    }
    for (base::Bytes& piece : listener_.sources_.ticks(all)) {
        connection_->send(TickPiece{std::move(piece)});
    }
}

void Peer::step(base::Bytes message) {
    sendTicks(false);
    ++steps_;
    if (message.size() <= kMaxMessage) {  // not one with sand that is loaded: timing tests are as long as the last
        stepBytes_ += message.size();
        lastStepBytes_ = message.size();
    }
    connection_->expectLoads(true);
    for (const auto& watcher : std::set(listener_.watchers_)) {  // a copy: who does not read leaves
        watcher->watchStep(message);
    }
    connection_->sendBytes(std::move(message));
}

void Peer::watchStep(const base::Bytes& message) {
    if (message.size() <= kMaxMessage) {  // not sand that is loaded: the master alone has asked for so much
        connection_->sendBytes(base::Bytes(message));
    }
}

void Peer::tickTimingTest(double pause) {
    // Poisson arrivals see time averages: no phase of a frame is met more often than it lasts.
    std::exponential_distribution<double> wait(listener_.tests_.perSecond);  // [s]
    testTimer_.expires_after(std::chrono::nanoseconds(static_cast<std::int64_t>((pause + wait(random_)) * 1e9)));
    testTimer_.async_wait([self = shared_from_this()](error_code error) {
        if (error || self->phase_ != Phase::linked) {
            return;
        }
        TimingTest test{++self->lastTest_, 0};
        const std::size_t bare = encode(test).size();
        test.padding = static_cast<std::uint32_t>(self->lastStepBytes_ > bare ? self->lastStepBytes_ - bare : 0);
        self->testsOut_[test.id].sentNs = host::monotonicNs();
        if (self->testsOut_.size() > kMaxTestsOut) {
            self->testsOut_.erase(self->testsOut_.begin());
        }
        self->connection_->send(test);
        self->tickTimingTest();
    });
}

void Peer::echoed(const TimingEcho& echo) {
    const auto test = testsOut_.find(echo.id);
    if (test == testsOut_.end()) {
        return;
    }
    const std::int64_t half = (host::monotonicNs() - test->second.sentNs) / 2;
    if (echo.leg == Leg::shown) {
        toWall_.add(half);
        testsOut_.erase(test);
    } else if (!std::exchange(test->second.received, true)) {
        toMaster_.add(half);
    }
}

void Peer::tickReport() {
    reportTimer_.expires_after(milliseconds(1000));
    reportTimer_.async_wait([self = shared_from_this()](error_code error) {
        if (!error && self->phase_ != Phase::over) {
            self->connection_->send(self->report());
            self->tickReport();
        }
    });
}

Report Peer::report() const {
    Report report = listener_.sources_.report();
    report.toWall = told(toWall_);
    report.toMaster = told(toMaster_);
    report.stepBytesMean = steps_ == 0 ? 0 : static_cast<double>(stepBytes_) / static_cast<double>(steps_);
    report.steps = steps_;
    report.refused = listener_.refused();
    return report;
}

void Peer::sayGoodbye(const std::string& reason) {
    if (phase_ == Phase::over) {
        return;
    }
    if (phase_ == Phase::linked) {
        sendTicks(true);
    }
    connection_->send(report());
    connection_->send(Bye{reason});
    const auto kept = connection_;
    end(reason);
    kept->finish();
}

void Peer::end(const std::string& why, Connection::Fault fault) {
    if (phase_ == Phase::over) {
        return;
    }
    const auto kept = shared_from_this();
    const bool guest = phase_ <= Phase::proving;
    // Masters come one at a time and are told of whenever they go; of guests and watchers a flood may come.
    const bool master = !guest && role_ == Role::move;
    if (master) {
        log(why);
    }
    if (fault) {
        const std::string who = guest ? "a guest: " : "a watcher: ";
        listener_.refused(*fault, connection_->address(), master ? "" : who + why);
    }
    if (guest) {
        listener_.guestWent(*this);
    }
    phase_ = Phase::over;
    reportTimer_.cancel();
    testTimer_.cancel();
    watchTimer_.cancel();
    listener_.watchers_.erase(kept);
    if (listener_.current_.get() == this) {
        listener_.current_ = nullptr;
        listener_.sandThread_->release();
    }
}

}  // namespace haptic_bridge
