// SPDX-License-Identifier: Apache-2.0
// The messages that a Peer receives: those of the greeting, and those of a linked master.
#include <fmt/format.h>

#include <limits>
#include <utility>
#include <variant>

#include "haptic_bridge/server/peer.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {
namespace {

constexpr double kWatcherRate = 50;                 // [message/s]; a watcher sends only four Pings per second
constexpr std::size_t kWatcherUnsent = 256 * 1024;  // [byte], about half a minute of steps

/// Returns whether a step with `edit` is longer than an ordinary message.
bool isLong(const sand::Edit& edit) { return edit.sand && edit.sand->size() > kMaxMessage; }

}  // namespace

void Peer::receive(Message&& message) {
    if (phase_ == Phase::over || phase_ == Phase::leaving) {
        return;
    }
    if (phase_ > Phase::proving) {
        silence_.heard(host::monotonicNs());
    }
    const bool passes = std::holds_alternative<Ping>(message) || std::holds_alternative<Bye>(message);
    if (phase_ == Phase::loading && !passes) {
        outOfTurn();
        return;
    }
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
    const auto compare = service_.loading ? refusalForVersions : refusalFor;
    if (const auto refusal = versionAlone ? std::nullopt : compare(service_.identity, hello.master)) {
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

void Peer::take(const StartMessage& start) {
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
    connection_->expectLoads(grant_.longLoad == 0, service_.mostLoad);
    service_.sandThread->edit(std::move(request));
}

void Peer::take(const ForceShare& force) {
    if (phase_ != Phase::granting && phase_ != Phase::linked) {
        outOfTurn();
        return;
    }
    service_.shareForce(force);
    if (force.byOperator && force.share > 0) {
        service_.switchOn();
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
    // Masters that wait for a scene are among the watchers, and half of the places are theirs.
    const std::size_t places = service_.loading && role_ == Role::watch ? kMaxWatchers / 2 : kMaxWatchers;
    if ((role_ == Role::watch || service_.loading) && roster_.watchers().size() >= places) {
        refuse({RefusalCode::busy, service_.loading
                                       ? "busy: others wait already until this server has read its scene"
                                       : fmt::format("busy: {} watchers are linked already", kMaxWatchers)});
        return;
    }
    connection_->setMaxIn(std::numeric_limits<std::uint64_t>::max());
    connection_->setLinger(Connection::kLinger);
    if (service_.loading) {
        phase_ = Phase::loading;
        roster_.promoteToWatcher(shared_from_this());
        connection_->setRate(kWatcherRate);
        tickLoading();
        return;
    }
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

}  // namespace haptic_bridge
