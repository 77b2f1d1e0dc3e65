// SPDX-License-Identifier: Apache-2.0
#include "master/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "base/input_error.hpp"
#include "host/build_id.hpp"
#include "host/clock.hpp"
#include "host/event.hpp"
#include "host/print_line.hpp"
#include "lockstep/session_message.hpp"
#include "master/start_up.hpp"
#include "master/wall_pictures.hpp"
#include "scene/scene.hpp"

namespace master {
namespace {

using haptic_bridge::TimedStep;
using host::monotonicNs;

constexpr std::size_t kMostStepsPerFrame = 8;  // a long catch-up is spread over frames
constexpr std::size_t kMostStepsPerFastFrame = 4;
constexpr double kFastPatience = 0.1;  // [s] that a fast session waits for a step before it shows a frame without
constexpr double kLate = 1.5;          // times its period that a late frame takes at least
constexpr double kAuditSeconds = 1.0;  // in which all of memory is hashed again, whatever the frame rate

/// What a session before has left in the folder must not pass for this one's, whatever becomes of this one.
void forgetOldResults(const std::filesystem::path& folder, bool resumed) {
    std::error_code none;  // usually there is nothing
    if (!resumed) {
        std::filesystem::remove(folder / "divergence.txt", none);
    }
    for (const char* name :
         {"summary.json", "failure.json", "wall.png", "wall_left.png", "wall_right.png", "wall_anaglyph.png"}) {
        std::filesystem::remove(folder / name, none);
    }
    std::vector<std::filesystem::path> tiles;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("tile_") && name.ends_with(".png")) {
            tiles.push_back(entry.path());
        }
    }
    for (const std::filesystem::path& tile : tiles) {
        std::filesystem::remove(tile, none);
    }
    Film::forget(folder);
}

std::vector<lockstep::Fault> faultsOf(const std::vector<Drill>& drills) {
    std::vector<lockstep::Fault> faults;
    faults.reserve(drills.size());
    for (const Drill& drill : drills) {
        faults.push_back(drill.fault);
    }
    return faults;
}

void sleepNs(std::int64_t ns) { std::this_thread::sleep_for(std::chrono::nanoseconds(ns)); }

double milliseconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-6; }

}  // namespace

Session::Session(const lockstep::Cluster& cluster, const scene::Scene& scene, const walls::Wall& wall,
                 SessionOptions options)
    : cluster_(cluster),
      wall_(wall),
      shown_(wall),
      place_(SandPlace::of(scene)),
      grid_(scene.grid()),
      material_(scene.material),
      options_(std::move(options)),
      terrain_(scene, options_.sweeps),
      names_(namesOf(cluster, wall)),
      barrier_(cluster, names_, options_.frameTimeout,
               [this](int rank, const std::string& line) {
                   (void)writeFailure(failureOf("hung", rank, line), options_.out);
               }),
      clock_(options_.refreshHz.value_or(wall.refreshHz)),
      views_(wall, scene, options_.tracker),
      viewProof_(wall.encode()),
      liveSteps_(options_.server, scene, options_.pace, options_.resumed ? options_.resumed->epoch : 0,
                 options_.security),
      operator_(options_.readInput),
      faults_(faultsOf(options_.drills), lockstep::kMaster),
      rankStatistics_(names_.size()),
      incidentFile_(options_.out, options_.resumed != nullptr) {
    if (options_.recording) {
        options_.steps = std::min(options_.steps, options_.recording->lastStep());
    } else {
        beginJournal(scene);
        control_.emplace(options_.out);
    }
    if (options_.film) {
        film_.emplace(wall, options_.filmEye, options_.out);
    }
    summary_.scene = scene.name;
    summary_.wall = wall.name;
    summary_.ranks = wall.ranks();
    // A resumed terrain has lost and won since.
    summary_.volumeInitial = scene.tin != nullptr ? sand::Replica(scene).volume() : scene.terrain.volume();
    for (const walls::Tile& tile : wall.tiles) {
        summary_.tileNames.push_back(tile.name);
    }
    views_.show(options_.pattern);
    views_.show(options_.layers);
    if (views_.viewer().port() != 0) {
        fmt::print("head tracking listens on port {}\n", views_.viewer().port());
        std::fflush(stdout);
        host::emitEvent("head_tracking", {{"state", "listening"}, {"port", views_.viewer().port()}});
    }
    summary_.divergences = incidentFile_.before().divergences;
    summary_.healed = incidentFile_.before().healed;
    summary_.serverDivergences = incidentFile_.before().serverDivergences;
    hash_ = terrain_.stateHash();
}

double Session::sessionTime() const {
    // A fast session shows every frame what a recorded head did then, however long the frame takes.
    return options_.pace == Pace::fast ? clock_.timeOf(frame_)
           : lastSwap_ == 0            ? 0
                                       : static_cast<double>(monotonicNs() - firstSwap_) * 1e-9;
}

std::int64_t Session::nextFrame() const {
    const bool atOnce = options_.pace == Pace::fast && !paused_ && !standing_;
    return atOnce ? 0 : clock_.next();
}

void Session::waitForFrameTime() {
    if (options_.pace == Pace::fast && !paused_ && !standing_) {
        return;
    }
    if (const std::int64_t early = clock_.begin(monotonicNs()); early > 0) {
        sleepNs(early);
    }
}

std::vector<TimedStep> Session::awaitSteps() {
    if (options_.recording) {
        std::vector<TimedStep> recorded;
        for (const sand::Step& step : options_.recording->stepsOf(frame_ + 1)) {
            if (step.number <= options_.steps) {
                recorded.emplace_back().step = step;
            }
        }
        return recorded;
    }
    const bool fast = options_.pace == Pace::fast;
    std::size_t most = fast ? kMostStepsPerFastFrame : kMostStepsPerFrame;
    const std::uint64_t left = options_.steps - std::min(options_.steps, terrain_.stepNumber());
    most = paused_ || !mayTakeSteps() ? 0 : std::min<std::uint64_t>(most, left);
    const std::int64_t since = monotonicNs();
    std::vector<TimedStep> steps = liveSteps_.next(terrain_, hash_, most);
    while (fast && most > 0 && steps.empty() && !operator_.stopAsked() &&
           static_cast<double>(monotonicNs() - since) * 1e-9 < kFastPatience) {
        sleepNs(500'000);
        steps = liveSteps_.next(terrain_, hash_, most);
    }
    return steps;
}

lockstep::FrameMessage Session::prepare(std::vector<TimedStep>& steps) {
    lockstep::FrameMessage message;
    message.frame = ++frame_;
    message.view = views_.at(sessionTime());
    for (const TimedStep& timed : steps) {
        message.steps.push_back(timed.step);
    }
    if (message.view.layers.shows(lockstep::Overlay::statistics)) {
        message.figures = wallFigures();
    }
    const std::uint64_t shownThen = terrain_.stepNumber() + steps.size();
    message.stop = operator_.stopAsked() || strayed_ || frame_ >= options_.frames || shownThen >= options_.steps;
    message.capture = film_.has_value() || (message.stop ? options_.pictures : !captures_.empty() && !capturing());
    const double sinceLast = lastSwap_ == 0 ? 0 : static_cast<double>(monotonicNs() - lastSwap_) * 1e-9;
    const int tiles = terrain_.hashTiles().tileCount();
    message.auditTiles = static_cast<std::uint32_t>(
        std::clamp(static_cast<int>(std::ceil(tiles * sinceLast / kAuditSeconds)), (tiles + 63) / 64, tiles));
    return message;
}

void Session::applySteps(const std::vector<TimedStep>& steps) {
    compareWithRecording();
    for (const TimedStep& timed : steps) {
        terrain_.apply(timed.step);
        summary_.edits += timed.step.edit.any() ? 1 : 0;
        compareWithRecording();
    }
}

void Session::compareWithRecording() {
    if (!options_.recording || strayed_) {
        return;
    }
    const auto recorded = options_.recording->hashAfter(terrain_.stepNumber());
    if (recorded && *recorded != terrain_.stateHash()) {
        strayLine_ = fmt::format(
            "after step {}: the session had {:016x}, now it is {:016x}; the recording is of another version or "
            "damaged, and ends here",
            terrain_.stepNumber(), *recorded, terrain_.stateHash());
        strayed_ = true;
    }
}

bool Session::showFrame() {
    waitForFrameTime();
    obeyOperator();
    keepTicks();  // before room is asked for, which they need as well
    std::vector<TimedStep> steps = awaitSteps();
    const std::uint64_t hashBefore = hash_;
    std::size_t bytes = 0;
    const lockstep::FrameMessage prepared = prepare(steps);
    startDrills();
    const lockstep::FrameMessage message = barrier_.begin(prepared, bytes);
    const std::int64_t broadcast = monotonicNs();
    summary_.broadcastBytes.add(static_cast<double>(bytes));
    if (!message.steps.empty()) {
        // The ranks draw meanwhile; none of them swaps before the master has come to the barrier.
        keepJournal({message.frame, hashBefore, message.steps});
    }
    faults_.strike(message.frame, terrain_);
    applySteps(steps);
    terrain_.audit(static_cast<int>(message.auditTiles));
    hash_ = terrain_.stateHash();

    const lockstep::Arrival mine{message.frame, monotonicNs(), lastSwap_, 0, hash_, viewProof_.hash(message.view)};
    if (!reachAgreement(barrier_.meet(mine, nextFrame()), mine)) {
        return false;
    }
    const std::int64_t swapped = monotonicNs();
    tellRecovery();
    incidentFile_.keep(incidents(), swapped);
    measureSwaps(swapped);
    measureLatency(steps, broadcast, swapped);
    answerEdits(steps);
    if (message.capture && !message.stop && !film_) {  // a film takes its own
        takeCapture();
    }
    liveSteps_.shown(terrain_.stepNumber(), swapped - (lastSwap_ == 0 ? swapped : lastSwap_));
    lastSwap_ = swapped;
    summary_.serverDivergences += liveSteps_.proveServer(steps, hash_) ? 0 : 1;
    if (journal_) {
        journal_->shown(terrain_, frame_, liveSteps_.epoch(), hash_);
    }
    stopping_ = message.stop;
    return true;
}

lockstep::WallFigures Session::wallFigures() const {
    const std::uint64_t agreed = rankStatistics_.frames();
    return {lastFrameMs_,    rankStatistics_.recentDrag(), agreed, summary_.divergences,
            summary_.healed, rankStatistics_.lastSwapsUs()};
}

void Session::measureSwaps(std::int64_t now) {
    // The ranks tell when they swapped the frame before this one; the first has nothing to tell.
    rankStatistics_.add(barrier_.arrivals(),
                        lastSwap_ != 0 && frame_ - summary_.framesBefore > options_.settlingFrames + 1);
    if (lastSwap_ == 0) {
        firstSwap_ = now;
        return;
    }
    lastFrameMs_ = milliseconds(now - lastSwap_);
    if (frame_ - summary_.framesBefore > options_.settlingFrames + 1) {
        summary_.frameMs.add(lastFrameMs_);
        const bool late = options_.pace == Pace::realtime && lastFrameMs_ > kLate * 1e3 * clock_.period();
        summary_.lateFrames += late ? 1 : 0;
    }
    const std::vector<std::uint32_t>& swaps = rankStatistics_.lastSwapsUs();
    if (!swaps.empty()) {
        lastSkewUs_ = *std::max_element(swaps.begin(), swaps.end());
        summary_.skewUs.add(lastSkewUs_);
    }
}

void Session::measureLatency(const std::vector<TimedStep>& steps, std::int64_t broadcast, std::int64_t swapped) {
    std::int64_t drawn = broadcast;
    for (std::size_t rank = 1; rank < barrier_.arrivals().size(); ++rank) {
        drawn = std::max(drawn, barrier_.arrivals()[rank].arrived);
    }
    for (const TimedStep& timed : steps) {
        if (timed.serverTimeNs == 0) {  // the master's own
            continue;
        }
        const std::int64_t sent = timed.serverTimeNs - liveSteps_.clockOffsetNs();
        Latency& latency = summary_.latency;
        latency.toMaster.add(milliseconds(timed.receivedNs - sent));
        latency.queued.add(milliseconds(broadcast - timed.receivedNs));
        latency.drawn.add(milliseconds(drawn - broadcast));
        latency.swapped.add(milliseconds(swapped - drawn));
        latency.wholeWay.add(milliseconds(swapped - sent));
    }
}

const char* Session::handInWords() const {
    return options_.recording       ? "recorded"
           : liveSteps_.linked()    ? "hand linked"
           : liveSteps_.streaming() ? "hand streams"
           : liveSteps_.starting()  ? "waiting for a hand"
                                    : "no hand";
}

void Session::sayProgress(bool last) {
    const std::int64_t now = monotonicNs();
    if (!last && now - lastProgress_ < 1'000'000'000) {
        return;
    }
    fps_ = lastProgress_ == 0
               ? 0
               : static_cast<double>(frame_ - lastProgressFrame_) / (static_cast<double>(now - lastProgress_) * 1e-9);
    const std::string of = options_.steps == kNoLimit ? "" : fmt::format("/{}", options_.steps);
    fmt::print("frame {}  step {}{}  {:.1f} fps  skew {:.0f} us  hashes agree  {}\n", frame_, terrain_.stepNumber(), of,
               fps_, lastSkewUs_, handInWords());
    std::fflush(stdout);
    host::emitEvent("progress", {{"frame", frame_},
                                 {"step", terrain_.stepNumber()},
                                 {"fps", fps_},
                                 {"skew_us", lastSkewUs_},
                                 {"hand", handInWords()}});
    lastProgress_ = now;
    lastProgressFrame_ = frame_;
}

void Session::finish(bool agreed) {
    const lockstep::Watched watched(barrier_.watchdog());
    liveSteps_.stop();
    try {
        keepTicks();                        // the last come with the goodbye
    } catch (const DiskFailure& failure) {  // the ranks still have reports and pictures to send
        host::printLine("{}", failure.what());
    }
    const Incidents all = incidents();
    incidentFile_.keepLast(all);
    endJournal(agreed);
    summary_.frames = frame_;
    summary_.steps = terrain_.stepNumber();
    summary_.stateHash = hash_;
    summary_.volumeFinal = terrain_.volume();
    summary_.volumeOutflow = terrain_.outflow();
    summary_.seconds = static_cast<double>(lastSwap_ - firstSwap_) * 1e-9;
    summary_.haptic = liveSteps_.report();
    if (views_.viewer().tracked()) {
        summary_.tracking = views_.viewer().counters();
    }
    summary_.link = liveSteps_.counters();
    summary_.link.links = all.links;
    summary_.link.reconnects = all.reconnects;
    summary_.link.refusedHere = all.refusedHere;
    summary_.link.refused = all.refused;
    summary_.journal.stands += incidentFile_.before().stands;
    summary_.ranksReports = lockstep::gatherReports(barrier_, {});
    summary_.rankStatistics = rankStatistics_.ranks();
    summary_.drag = rankStatistics_.drag();
    summary_.rankNames = names_;
    summary_.masterResidentBytes = lockstep::residentBytes();
    summary_.recoveries = recoveriesOf(options_.out);
}

int Session::run() {
    forgetOldResults(options_.out, options_.resumed != nullptr);
    if (!options_.resumed) {
        forgetRecoveries(options_.out);
        incidentFile_.forget();
    }
    bool agreed = true;
    while (agreed && !stopping_) {
        agreed = showFrame();
        if (agreed) {
            sayProgress(stopping_);
        }
        if (agreed && film_ && !stopping_) {
            film_->take(cluster_, barrier_.watchdog());
        }
    }
    finishErrands(true);
    control_.reset();  // whoever asks now finds no session
    finish(agreed);
    int status = agreed && !strayed_ ? 0 : 1;
    try {
        writeSummary(summary_, options_.out / "summary.json");
    } catch (const base::InputError& error) {  // the ranks still have pictures to send
        host::printLine("{}", error.what());
        status = 1;
    }
    if (agreed && film_) {
        film_->take(cluster_, barrier_.watchdog());
    } else if (agreed && options_.pictures) {
        writeWallPictures(cluster_, shown_, options_.out, barrier_.watchdog());
    }
    fmt::print("{}", describe(summary_));
    return status;
}

}  // namespace master
