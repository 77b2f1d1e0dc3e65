// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/sand_thread.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "haptic_bridge/devices/sand_watcher.hpp"
#include "haptic_bridge/loop/felt_sand.hpp"
#include "host/clock.hpp"
#include "scene/scene.hpp"

namespace haptic_bridge {
namespace {

constexpr std::int64_t kIdlePoll = 20'000'000;    // [ns]: an idle sand thread empties the hand's queue this often
constexpr std::int64_t kMillisecond = 1'000'000;  // [ns]

}  // namespace

SandThread::SandThread(const scene::Scene& scene, Pace pace, HapticTick& hand, HandChannel& channel, Output output,
                       const sand::grid::Erosion::Options& sweeps, SandWatcher* watcher)
    : scene_(scene),
      pace_(pace),
      hand_(hand),
      channel_(channel),
      output_(std::move(output)),
      terrain_(scene, sweeps),
      path_(scene.rules.stepsPerSecond),
      clock_(scene.rules.stepsPerSecond),
      watcher_(watcher) {
    showSand();
    thread_ = std::thread([this] { run(); });
}

SandThread::~SandThread() {
    post(Stop{});
    thread_.join();
}

void SandThread::post(Command command) {
    {
        const std::lock_guard lock(mutex_);
        commands_.push_back(std::move(command));
    }
    wake_.notify_one();
}

void SandThread::run() {
    while (!stopping_) {
        const bool stepDue = waitForWork();
        std::deque<Command> commands;
        {
            const std::lock_guard lock(mutex_);
            commands.swap(commands_);
        }
        for (Command& command : commands) {
            std::visit([this](auto& kind) { obey(kind); }, command);
        }
        collect();
        if (stepDue && commands.empty() && phase_ == Phase::running) {
            makeStep();
        }
    }
}

/// Sleeps until a command comes or a step is due; says whether one is.
bool SandThread::waitForWork() {
    std::unique_lock lock(mutex_);
    const auto commanded = [this] { return !commands_.empty(); };
    if (pace_ == Pace::fast) {
        if (phase_ != Phase::running || blocked()) {
            wake_.wait(lock, commanded);
            return false;
        }
        return true;
    }
    const bool running = phase_ == Phase::running;
    const std::int64_t until = running ? clock_.due() : host::monotonicNs() + kIdlePoll;
    const std::chrono::steady_clock::time_point when{std::chrono::nanoseconds(until)};
    return !wake_.wait_until(lock, when, commanded) && running;
}

void SandThread::obey(Granted& command) {
    session_ = command.session;
    start_ = command.start;
    if (terrain_.stepNumber() == start_.stepNumber && terrain_.stateHash() == start_.stateHash) {
        begin();
    } else {
        phase_ = Phase::awaitingState;
        output_.needState(session_, {terrain_.stepNumber(), terrain_.stateHash()});
    }
}

void SandThread::obey(State& command) {
    if (phase_ != Phase::awaitingState) {
        return;
    }
    phase_ = Phase::idle;
    try {
        terrain_.decodeState(command.bytes);
    } catch (const base::FormatError& error) {
        output_.unusable(session_, std::string("the state sent is none of this scene: ") + error.what());
        return;
    }
    if (terrain_.stepNumber() != start_.stepNumber || terrain_.stateHash() != start_.stateHash) {
        output_.unusable(session_, "the state sent does not have the hash that was announced");
        return;
    }
    begin();
}

void SandThread::obey(CatchUp& command) {
    if (phase_ != Phase::awaitingState) {
        return;
    }
    bool fits = true;
    for (const sand::Step& step : command.steps) {
        fits = fits && step.number == terrain_.stepNumber() + 1 && step.number <= start_.stepNumber;
        if (fits) {
            terrain_.apply(step);
        }
    }
    if (fits && !command.last) {
        return;
    }
    if (fits && terrain_.stepNumber() == start_.stepNumber && terrain_.stateHash() == start_.stateHash) {
        begin();
    } else {
        output_.needState(session_, {});  // the whole sand, whatever is here
    }
}

void SandThread::obey(Frame& command) {
    if (phase_ != Phase::running) {
        return;
    }
    // Never backwards, and never ahead of what was sent, whatever a master claims.
    shown_ = std::max(shown_, std::min(command.shown.stepNumber, terrain_.stepNumber()));
    clock_.frameShown(command.nowNs, command.shown.frameIntervalNs);
}

void SandThread::obey(Released&) {
    phase_ = Phase::idle;
    channel_.moving = false;
    path_.dropWaiting();
}

void SandThread::begin() {
    phase_ = Phase::running;
    edit_ = {};
    shown_ = start_.stepNumber;
    // Whoever numbered before may have left the tool in the sand elsewhere: no furrow from there to here.
    liftFirst_ = terrain_.engaged();
    path_.restart(terrain_.probe(), false);
    clock_.start(host::monotonicNs());
    if (pace_ == Pace::fast) {  // in real time the force loop reads a hand that rests
        const auto rate = static_cast<std::uint64_t>(scene_.rules.stepsPerSecond);
        hand_.rest(static_cast<double>(virtualSteps_ * 1000 / rate) * HapticTick::kTick);
    }
    publishSurface();
    showSand();
    ++channel_.sitting;
    if (pace_ == Pace::fast) {
        channel_.beginSitting(hand_);
    }
    channel_.moving = true;
    output_.ready(session_);
}

void SandThread::collect() {
    channel_.samples.consume_all([this](const HandSample& sample) {
        if (phase_ == Phase::running) {
            path_.add(sample);
        }
    });
    dropped_ = path_.dropped();
}

void SandThread::gatherVirtual() {
    const auto rate = static_cast<std::uint64_t>(scene_.rules.stepsPerSecond);
    const std::uint64_t first = virtualSteps_ * 1000 / rate + 1, last = (virtualSteps_ + 1) * 1000 / rate;
    ++virtualSteps_;
    for (std::uint64_t millisecond = first; millisecond <= last; ++millisecond) {
        // The sand was last computed one step ago; under a virtual clock it is never stale.
        const auto now = static_cast<std::int64_t>(millisecond) * kMillisecond;
        virtualSurface_.timeNs = now;
        path_.add(hand_.tick(static_cast<double>(millisecond) * HapticTick::kTick, now, virtualSurface_));
        channel_.keepTick();
    }
}

void SandThread::makeStep() {
    if (blocked()) {  // in real time only: the fast pace waits instead
        ++withheld_;
        publishSurface();  // the same sand, but not a stale one: a hand goes on to feel a wall that waits
        clock_.advance(host::monotonicNs());
        return;
    }
    StepMessage message;
    message.step.epoch = start_.epoch;
    message.step.number = terrain_.stepNumber() + 1;
    message.serverTimeNs = host::monotonicNs();
    if (!std::exchange(liftFirst_, false)) {
        if (pace_ == Pace::fast) {
            gatherVirtual();
        }
        const std::int64_t readNs = path_.take(message.step);
        std::optional<sand::Heading>& heading = message.step.heading;
        if (sand::isRound(terrain_.toolShape().kind) || heading == terrain_.heading()) {
            heading.reset();  // nothing that the sand would notice
        }
        if (pace_ == Pace::realtime && readNs != 0) {
            message.serverTimeNs = readNs;
        }
    }
    message.step.edit = std::exchange(edit_, {});
    terrain_.apply(message.step);
    message.stateHash = terrain_.stateHash();
    output_.step(session_, encode(std::move(message)));
    publishSurface();
    showSand();
    clock_.advance(host::monotonicNs());
}

/// Around the hand, and not around the tool: before a link's first step the tool is where no hand has been, and later a
/// hand may be ahead of its tool.
void SandThread::publishSurface() {
    const sand::ProbePoint around = hand_.where();
    if (pace_ == Pace::fast) {
        takeSurface(terrain_, around, virtualSurface_);
        return;
    }
    FeltSand& next = channel_.surface.next();
    takeSurface(terrain_, around, next);
    next.timeNs = host::monotonicNs();
    channel_.surface.publish();
}

void SandThread::showSand() {
    if (watcher_ != nullptr) {
        watcher_->stepped(terrain_);
    }
}

}  // namespace haptic_bridge
