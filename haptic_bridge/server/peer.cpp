// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/peer.hpp"

#include <fmt/format.h>

#include <chrono>
#include <limits>
#include <utility>

#include "haptic_bridge/link/step_ring.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {

using boost::system::error_code;
using std::chrono::milliseconds;

namespace {

constexpr std::int64_t kGreetingNs = 3'000'000'000;  // [ns], time in which an unauthenticated connection must greet
constexpr std::int64_t kSilenceNs = 10'000'000'000;  // [ns]; a master sends a Ping four times a second
constexpr std::uint64_t kGreetingBytes = 16 * 1024;  // [byte]; a greeting takes some hundreds, TLS some hundreds more
constexpr double kWatcherRate = 50;                  // [message/s]; a watcher sends only four Pings per second
constexpr std::size_t kWatcherUnsent = 256 * 1024;   // [byte], about half a minute of steps

/// Returns whether a step with `edit` is longer than an ordinary message.
bool isLong(const sand::Edit& edit) { return edit.sand && edit.sand->size() > kMaxMessage; }

}  // namespace

Peer::Peer(const Service& service, Gate& gate, Roster<Peer>& roster, Connection::Socket socket)
    : service_(service),
      gate_(gate),
      roster_(roster),
      connection_(roster.counted(std::make_unique<Connection>(
          std::move(socket), service.security.tls ? service.security.tls->open() : nullptr))),
      reportTimer_(service.io),
      testTimer_(service.io),
      watchTimer_(service.io),
      handshake_(service.security),
      roundTrips_(service.tests) {}

void Peer::start() {
    heardNs_ = host::monotonicNs();
    connection_->limit(kMaxGreeting);
    connection_->setMaxIn(kGreetingBytes);
    if (roster_.connections() > kMaxConnections / 2) {
        connection_->setLinger(milliseconds(0));  // a refused connection must not keep a place
    }
    connection_->start(
        {[self = shared_from_this()](Message&& message) { self->receive(std::move(message)); },
         [self = shared_from_this()](const std::string& why, Connection::Fault fault) { self->end(why, fault); },
         true});
    watch();
}

void Peer::makeRoom() {
    const auto kept = shared_from_this();
    connection_->close("it has not greeted yet, and other connections wait", RefusalCode::limit);
}

void Peer::log(const std::string& what) const {
    service_.log(fmt::format("{} {}: {}", role_ == Role::move ? "master" : "watcher", connection_->peer(), what));
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
    if (phase_ == Phase::over || phase_ == Phase::leaving) {
        return;
    }
    heardNs_ = phase_ <= Phase::proving ? heardNs_ : host::monotonicNs();
    const bool passes = std::holds_alternative<Ping>(message) || std::holds_alternative<Bye>(message);
    if (phase_ == Phase::watching && !passes) {
        refuse({RefusalCode::role, "a watcher only listens; this message needs the secret of role move"});
        return;
    }
    std::visit([this](auto& kind) { take(kind); }, message);
}

void Peer::take(const Hello& hello) {
    if (phase_ != Phase::greeting) {
        outOfTurn();
        return;
    }
    // A watcher has no sand, so only the protocol version must be equal.
    const bool versionAlone = hello.role == Role::watch && hello.master.protocol == kProtocolVersion;
    if (const auto refusal = versionAlone ? std::nullopt : refusalFor(service_.identity, hello.master)) {
        refuse(*refusal);
        return;
    }
    if (const auto refusal = handshake_.refusalFor(hello, connection_->overTls())) {
        refuse(*refusal);
        return;
    }
    role_ = hello.role;
    scene_ = hello.master.sceneName;
    if (const auto challenge = handshake_.challenge(hello, service_.identity, connection_->binding())) {
        phase_ = Phase::proving;
        connection_->send(*challenge);
    } else {
        welcome();
    }
}

void Peer::take(const Proof& proof) {
    if (phase_ != Phase::proving) {
        outOfTurn();
    } else if (!handshake_.accepts(proof)) {
        refuse({RefusalCode::secret,
                fmt::format("the secret of role {} differs here; give both sides the same --secret-file",
                            base::nameOf(role_))});
    } else {
        welcome();
    }
}

void Peer::take(const Ping& ping) {
    phase_ <= Phase::proving ? outOfTurn() : connection_->send(Pong{ping.masterNs, host::monotonicNs()});
}

void Peer::take(const Bye&) {
    if (phase_ <= Phase::proving) {
        outOfTurn();
    } else {
        sendGoodbye(role_ == Role::move ? "the master has said goodbye" : "the watcher has said goodbye");
    }
}

void Peer::take(const Start& start) {
    if (phase_ != Phase::waiting) {
        outOfTurn();
        return;
    }
    phase_ = Phase::granting;
    grant_.epoch = start.epoch;
    grant_.firstStep = start.stepNumber + 1;
    service_.shareForce(start.force);
    service_.sandThread->start(session_, start);
}

void Peer::take(State& state) {
    phase_ != Phase::granting ? outOfTurn() : service_.sandThread->state(std::move(state.bytes));
}

void Peer::take(CatchUp& catchUp) {
    if (phase_ != Phase::granting || grant_.catchUpsLeft == 0) {
        outOfTurn();
        return;
    }
    grant_.catchUpsLeft = catchUp.last ? 0 : grant_.catchUpsLeft - 1;
    service_.sandThread->catchUp(std::move(catchUp));
}

void Peer::take(const Shown& shown) {
    if (phase_ != Phase::linked) {
        outOfTurn();
    } else if (shown.stepNumber + 1 > grant_.firstStep + sent_.steps) {
        connection_->close(fmt::format("it claims to show step {}, which was not sent", shown.stepNumber),
                           RefusalCode::garbage);
    } else {
        service_.sandThread->shown(shown, host::monotonicNs());
    }
}

void Peer::take(const TimingEcho& echo) {
    phase_ != Phase::linked ? outOfTurn() : roundTrips_.echoed(echo, host::monotonicNs());
}

void Peer::take(EditRequest& request) {
    if (phase_ != Phase::linked) {
        outOfTurn();
        return;
    }
    // One long load at a time: until it is in a step, or until another edit has replaced it.
    grant_.longLoad = isLong(request.edit) ? request.edit.number : 0;
    connection_->expectLoads(grant_.longLoad == 0);
    service_.sandThread->edit(std::move(request));
}

void Peer::take(const ForceShare& force) {
    if (phase_ != Phase::granting && phase_ != Phase::linked) {
        outOfTurn();
    } else {
        service_.shareForce(force);
    }
}

/// Welcomes the peer, or refuses it if there is no place for it. Only after the proof may a peer learn who else is
/// connected.
void Peer::welcome() {
    if (role_ == Role::move && roster_.master()) {
        refuse({RefusalCode::busy, fmt::format("busy: the master at {} is linked; one wall at a time",
                                               roster_.master()->connection_->peer())});
        return;
    }
    if (role_ == Role::watch && roster_.watchersAreFull()) {
        refuse({RefusalCode::busy, fmt::format("busy: {} watchers are linked already", kMaxWatchers)});
        return;
    }
    connection_->setMaxIn(std::numeric_limits<std::uint64_t>::max());
    connection_->setLinger(Connection::kLinger);
    if (role_ == Role::move) {
        phase_ = Phase::waiting;
        session_ = roster_.promoteToMaster(shared_from_this());
        connection_->limit(kMaxMessage);
    } else {
        phase_ = Phase::watching;
        roster_.promoteToWatcher(shared_from_this());
        connection_->setRate(kWatcherRate);
        connection_->setMaxUnsent(kWatcherUnsent);
    }
    connection_->send(Welcome{service_.identity, service_.stepsPerSecond, role_, handshake_.mac()});
    if (role_ == Role::move) {
        log(fmt::format("welcome, scene '{}'{}{}", scene_, service_.security.proves() ? ", secret proved" : "",
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
    log(fmt::format("linked, epoch {} from step {}", grant_.epoch, grant_.firstStep));
    connection_->send(Ready{});
    tickTimingTest(service_.tests.after);
}

void Peer::needState(const NeedState& need) {
    connection_->expectState(true);
    // Steps are accepted only the first time. After that the master must send the whole sand.
    grant_.catchUpsLeft = std::exchange(grant_.askedForSteps, true) ? 0 : StepRing::kSteps / kMaxCatchUp;
    connection_->send(need);
}

void Peer::unusable(const std::string& why) { refuse({RefusalCode::state, why}); }

void Peer::sendTicks(bool all) {
    if (!service_.ticks) {
        return;
    }
    for (base::Bytes& piece : service_.ticks(all)) {
        connection_->send(TickPiece{std::move(piece)});
    }
}

void Peer::step(base::Bytes message, std::uint64_t edit) {
    sendTicks(false);
    ++sent_.steps;
    sent_.bytes += message.size();
    sent_.lastBytes = message.size();
    if (edit != 0 && edit == grant_.longLoad) {
        grant_.longLoad = 0;
        connection_->expectLoads(true);
    }
    for (const auto& watcher : roster_.watchers()) {
        watcher->connection_->sendBytes(base::Bytes(message));
    }
    connection_->sendBytes(std::move(message));
}

void Peer::tickTimingTest(double pause) {
    const double wait = pause + roundTrips_.pause();
    testTimer_.expires_after(std::chrono::nanoseconds(static_cast<std::int64_t>(wait * 1e9)));
    testTimer_.async_wait([self = shared_from_this()](error_code error) {
        if (!error && self->phase_ == Phase::linked) {
            self->connection_->send(self->roundTrips_.next(self->sent_.lastBytes, host::monotonicNs()));
            self->tickTimingTest();
        }
    });
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
    Report report = service_.report();
    roundTrips_.fill(report);
    report.stepBytesMean = sent_.steps == 0 ? 0 : static_cast<double>(sent_.bytes) / static_cast<double>(sent_.steps);
    report.steps = sent_.steps;
    report.refused = gate_.counts();
    return report;
}

void Peer::sendGoodbye(const std::string& reason) {
    if (phase_ == Phase::over || phase_ == Phase::leaving) {
        return;
    }
    goodbye_ = reason;
    if (phase_ != Phase::linked) {
        close(Audited::no);
        return;
    }
    phase_ = Phase::leaving;
    service_.shareForce(std::nullopt);  // the hand must not feel the sand of a wall that has left
    service_.sandThread->audit();
    testTimer_.expires_after(kAuditPatience);
    testTimer_.async_wait([self = shared_from_this()](error_code error) {
        if (!error) {
            self->audited(Audited::no);
        }
    });
}

void Peer::audited(Audited result) {
    if (phase_ == Phase::leaving) {
        sendTicks(true);
        close(result);
    }
}

void Peer::close(Audited result) {
    Report last = report();
    last.audited = result;
    connection_->send(last);
    connection_->send(Bye{goodbye_});
    const auto kept = connection_;
    end(goodbye_);
    kept->finish();
}

void Peer::end(const std::string& why, Connection::Fault fault) {
    if (phase_ == Phase::over) {
        return;
    }
    const auto kept = shared_from_this();
    const bool unauthenticated = phase_ <= Phase::proving;
    // Masters come one at a time, so each end is logged. Unauthenticated connections and watchers may come in floods.
    const bool master = !unauthenticated && role_ == Role::move;
    if (master) {
        log(why);
    }
    if (fault) {
        const std::string name = unauthenticated ? "an unauthenticated connection: " : "a watcher: ";
        gate_.refused(*fault, connection_->address(), master ? "" : name + why, host::monotonicNs());
    }
    phase_ = Phase::over;
    reportTimer_.cancel();
    testTimer_.cancel();
    watchTimer_.cancel();
    if (roster_.remove(kept)) {
        service_.shareForce(std::nullopt);
        service_.sandThread->release();
    }
}

}  // namespace haptic_bridge
