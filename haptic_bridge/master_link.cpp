// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/master_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "haptic_bridge/monotonic.hpp"

namespace haptic_bridge {

using boost::system::error_code;
using std::chrono::milliseconds;

namespace {

constexpr std::int64_t kGreetingNs = 3'000'000'000;  // a guest must greet within
constexpr std::int64_t kSilenceNs = 10'000'000'000;  // a master pings four times a second
constexpr std::size_t kMaxTestsOut = 64;

HalfRoundTrip told(const LiveHistogram& halves) {
    return {halves.meanNs() * 1e-6, halves.stddevNs() * 1e-6, halves.percentileNs(0.50) * 1e-6,
            halves.percentileNs(0.99) * 1e-6, halves.count()};
}

}  // namespace

MasterLink::MasterLink(LinkServer& server, Connection::Socket socket)
    : server_(server),
      connection_(std::make_shared<Connection>(std::move(socket))),
      reportTimer_(server.io_),
      testTimer_(server.io_),
      watchTimer_(server.io_),
      random_(server.tests_.seed) {}

void MasterLink::start() {
    ++server_.guests_;
    heardNs_ = monotonicNs();
    connection_->start({[self = shared_from_this()](Message&& message) { self->receive(std::move(message)); },
                        [self = shared_from_this()](const std::string& why, bool) { self->end(why); }, true});
    watch();
}

void MasterLink::log(const std::string& what) const {
    server_.sources_.log(fmt::format("master {}: {}", connection_->peer(), what));
}

void MasterLink::watch() {
    watchTimer_.expires_after(milliseconds(500));
    watchTimer_.async_wait([self = shared_from_this()](error_code error) {
        if (error || self->phase_ == Phase::over) {
            return;
        }
        const std::int64_t silence = monotonicNs() - self->heardNs_;
        const std::int64_t most = self->phase_ == Phase::greeting ? kGreetingNs : kSilenceNs;
        if (silence > most) {
            self->connection_->close(fmt::format("silent for {} s", most / 1'000'000'000));
            return;
        }
        self->watch();
    });
}

void MasterLink::receive(Message&& message) {
    if (phase_ == Phase::over) {
        return;
    }
    heardNs_ = phase_ == Phase::greeting ? heardNs_ : monotonicNs();
    if (const auto* hello = std::get_if<Hello>(&message); hello != nullptr && phase_ == Phase::greeting) {
        greet(*hello);
    } else if (phase_ == Phase::greeting) {
        outOfTurn();
    } else if (const auto* ping = std::get_if<Ping>(&message)) {
        connection_->send(Pong{ping->masterNs, monotonicNs()});
    } else if (std::holds_alternative<Bye>(message)) {
        sayGoodbye("the master has said goodbye");
    } else if (const auto* start = std::get_if<Start>(&message); start != nullptr && phase_ == Phase::waiting) {
        phase_ = Phase::granting;
        epoch_ = start->epoch;
        firstStep_ = start->stepNumber + 1;
        server_.sequencer_->start(session_, *start);
    } else if (auto* state = std::get_if<State>(&message); state != nullptr && phase_ == Phase::granting) {
        server_.sequencer_->state(std::move(state->bytes));
    } else if (const auto* shown = std::get_if<Shown>(&message); shown != nullptr && phase_ == Phase::linked) {
        if (shown->stepNumber + 1 > firstStep_ + steps_) {
            connection_->close(fmt::format("it claims to show step {}, which was not sent", shown->stepNumber), true);
            return;
        }
        server_.sequencer_->shown(*shown, monotonicNs());
    } else if (const auto* echo = std::get_if<TimingEcho>(&message); echo != nullptr && phase_ == Phase::linked) {
        echoed(*echo);
    } else if (auto* request = std::get_if<EditRequest>(&message); request != nullptr && phase_ == Phase::linked) {
        server_.sequencer_->edit(std::move(*request));
    } else if (const auto* force = std::get_if<ForceShare>(&message); force != nullptr && phase_ == Phase::linked) {
        if (server_.sources_.shareForce) {
            server_.sources_.shareForce(force->share);
        }
    } else {
        outOfTurn();
    }
}

void MasterLink::greet(const Hello& hello) {
    if (const auto refusal = refusalFor(server_.identity_, hello.master)) {
        refuse(*refusal);
        return;
    }
    if (server_.current_) {
        refuse({RefusalCode::busy, fmt::format("busy: the master at {} is linked; one wall at a time",
                                               server_.current_->connection_->peer())});
        return;
    }
    --server_.guests_;
    phase_ = Phase::waiting;
    session_ = ++server_.sessions_;
    server_.current_ = shared_from_this();
    connection_->send(Welcome{server_.identity_, server_.stepsPerSecond_});
    log(fmt::format("welcome, scene '{}'", hello.master.sceneName));
    tickReport();
}

void MasterLink::refuse(const Refusal& refusal) {
    connection_->send(refusal);
    const auto kept = connection_;
    end("refused: " + refusal.text);
    kept->finish();
}

void MasterLink::outOfTurn() { refuse({RefusalCode::garbage, "that message was out of turn"}); }

void MasterLink::ready() {
    phase_ = Phase::linked;
    connection_->expectState(false);
    connection_->expectLoads(true);
    log(fmt::format("linked, epoch {} from step {}", epoch_, firstStep_));
    connection_->send(Ready{});
    tickTimingTest(server_.tests_.after);
}

void MasterLink::needState() {
    connection_->expectState(true);
    connection_->send(NeedState{});
}

void MasterLink::unusable(const std::string& why) { refuse({RefusalCode::state, why}); }

void MasterLink::sendTicks(bool all) {
    if (!server_.sources_.ticks) {
        return;
    }
    for (files::Bytes& piece : server_.sources_.ticks(all)) {
        connection_->send(TickPiece{std::move(piece)});
    }
}

void MasterLink::step(files::Bytes message) {
    sendTicks(false);
    ++steps_;
    if (message.size() <= kMaxMessage) {  // not one with sand that is loaded: timing tests are as long as the last
        stepBytes_ += message.size();
        lastStepBytes_ = message.size();
    }
    connection_->sendBytes(std::move(message));
}

void MasterLink::tickTimingTest(double pause) {
    // Poisson arrivals see time averages: no phase of a frame is met more often than it lasts.
    std::exponential_distribution<double> wait(server_.tests_.perSecond);  // [s]
    testTimer_.expires_after(std::chrono::nanoseconds(static_cast<std::int64_t>((pause + wait(random_)) * 1e9)));
    testTimer_.async_wait([self = shared_from_this()](error_code error) {
        if (error || self->phase_ != Phase::linked) {
            return;
        }
        TimingTest test{++self->lastTest_, 0};
        const std::size_t bare = encode(test).size();
        test.padding = static_cast<std::uint32_t>(self->lastStepBytes_ > bare ? self->lastStepBytes_ - bare : 0);
        self->testsOut_[test.id].sentNs = monotonicNs();
        if (self->testsOut_.size() > kMaxTestsOut) {
            self->testsOut_.erase(self->testsOut_.begin());
        }
        self->connection_->send(test);
        self->tickTimingTest();
    });
}

void MasterLink::echoed(const TimingEcho& echo) {
    const auto test = testsOut_.find(echo.id);
    if (test == testsOut_.end()) {
        return;
    }
    const std::int64_t half = (monotonicNs() - test->second.sentNs) / 2;
    if (echo.leg == Leg::shown) {
        toWall_.add(half);
        testsOut_.erase(test);
    } else if (!std::exchange(test->second.received, true)) {
        toMaster_.add(half);
    }
}

void MasterLink::tickReport() {
    reportTimer_.expires_after(milliseconds(1000));
    reportTimer_.async_wait([self = shared_from_this()](error_code error) {
        if (!error && self->phase_ != Phase::over) {
            self->connection_->send(self->report());
            self->tickReport();
        }
    });
}

Report MasterLink::report() const {
    Report report = server_.sources_.report();
    report.toWall = told(toWall_);
    report.toMaster = told(toMaster_);
    report.stepBytesMean = steps_ == 0 ? 0 : static_cast<double>(stepBytes_) / static_cast<double>(steps_);
    report.steps = steps_;
    return report;
}

void MasterLink::sayGoodbye(const std::string& reason) {
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

void MasterLink::end(const std::string& why) {
    if (phase_ == Phase::over) {
        return;
    }
    const auto kept = shared_from_this();
    log(why);
    server_.guests_ -= phase_ == Phase::greeting ? 1 : 0;
    phase_ = Phase::over;
    reportTimer_.cancel();
    testTimer_.cancel();
    watchTimer_.cancel();
    if (server_.current_.get() == this) {
        server_.current_ = nullptr;
        server_.sequencer_->release();
    }
}

}  // namespace haptic_bridge
