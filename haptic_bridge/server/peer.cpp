// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/peer.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "haptic_bridge/link/step_ring.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {

using boost::system::error_code;
using std::chrono::milliseconds;

namespace {

constexpr std::int64_t kGreetingNs = 3'000'000'000;  // [ns], time in which an unauthenticated connection must greet
constexpr std::uint64_t kGreetingBytes = 16 * 1024;  // [byte]; a greeting takes some hundreds, TLS some hundreds more

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
    silence_.heard(host::monotonicNs());
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
        const std::int64_t now = host::monotonicNs();
        if (self->phase_ > Phase::proving) {
            self->silence_.arrived(self->connection_->bytesIn(), now);
        }
        const std::int64_t most = self->phase_ <= Phase::proving ? kGreetingNs : kSilenceNs;
        if (self->silence_.lengthNs(now) > most) {
            self->connection_->close(
                fmt::format("silent for {} s", most / 1'000'000'000),
                self->phase_ <= Phase::proving ? Connection::Fault(RefusalCode::limit) : std::nullopt);
            return;
        }
        self->watch();
    });
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
    connection_->expectLoads(true, service_.mostLoad);
    log(fmt::format("linked, epoch {} from step {}", grant_.epoch, grant_.firstStep));
    connection_->send(Ready{service_.forceCeiling});
    tickTimingTest(service_.tests.after);
}

void Peer::needState(const NeedState& need) {
    connection_->expectState(true, service_.mostState);
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
        connection_->expectLoads(true, service_.mostLoad);
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

void Peer::tickLoading() {
    connection_->send(Loading{service_.loading(), handshake_.mac()});
    reportTimer_.expires_after(milliseconds(500));
    reportTimer_.async_wait([self = shared_from_this()](error_code error) {
        if (!error && self->phase_ == Phase::loading) {
            self->tickLoading();
        }
    });
}

void Peer::endLoading(const std::string& why) {
    if (phase_ == Phase::over) {
        return;
    }
    if (phase_ == Phase::loading) {
        connection_->send(Loading{service_.loading(), handshake_.mac()});
    }
    if (phase_ != Phase::greeting) {  // TLS may not be there yet
        connection_->send(Bye{why});
    }
    const auto kept = connection_;
    end(why);
    kept->finish();
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
    if (phase_ == Phase::loading) {
        endLoading(reason);
        return;
    }
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
    const bool master = !unauthenticated && role_ == Role::move && phase_ != Phase::loading;
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
