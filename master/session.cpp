// SPDX-License-Identifier: Apache-2.0
#include "master/session.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "haptic_bridge/hand/sweep_budget.hpp"
#include "host/clock.hpp"
#include "host/event.hpp"
#include "host/print_line.hpp"
#include "master/measure/failure_report.hpp"
#include "master/measure/slowest_host.hpp"

namespace master {
namespace {

using host::monotonicNs;

std::vector<sand::Step> untimed(const ArrivedSteps& steps) {
    std::vector<sand::Step> result;
    result.reserve(steps.size());
    for (const ArrivedStep& timed : steps) {
        result.push_back(timed.step);
    }
    return result;
}

}  // namespace

Session::Session(const lockstep::Cluster& cluster, const scene::Scene& scene, const walls::Wall& wall,
                 SessionOptions options, MasterSand sand)
    : scene_(scene),
      wall_(wall),
      options_(completed(std::move(options))),
      labels_(RankLabels::of(cluster, wall)),
      hosts_(cluster.hosts()),
      volumeOfHeights_(scene.volumeOfHeights()),
      barrier_(cluster, labels_.names, options_.frameTimeout,
               [this](int rank, const std::string& line) {
                   (void)writeFailure(labels_.failure("hung", rank, line), options_.out);
               }),
      frame_(options_.record.resumed ? options_.record.resumed->frame : 0),
      clock_(options_.refreshHz.value_or(wall.refreshHz), options_.pace),
      sand_(std::move(sand)),
      edits_(options_.record.resumed ? options_.record.resumed->lastEdit : 0),
      steps_(stepsOf(options_, scene, edits_)),
      record_(options_.out, options_.record, scene, labels_),
      counted_(record_.before()),
      desk_(
          scene, options_.record.resumed ? options_.record.resumed->material : scene.material, wall, options_.out,
          options_.desk,
          {sand_, edits_, steps_->force(), [this](std::int64_t bytes) { return record_.hasRoomForEdit(bytes, sand_); },
           [this](double share) { record_.keepForce(share); }, [this] { return status(); },
           !record_.journalFile().empty()}),
      measure_(labels_.names.size(), frame_ + options_.settlingFrames, clock_.period(), options_.pace,
               scene.rules.stepsPerSecond),
      dark_(wall, labels_.names),
      check_(wall, labels_, options_.out,
             {barrier_,
              counted_,
              measure_.ranks(),
              {[this] { return record_.journalFile(); },
               [this] { return record_.sandOfJournal(sand_, options_.executor); }},
              {[this] { return record_.journalFile(); },
               [this](const journal::JournalDoubt& doubt) { record_.doubt(doubt); },
               [this](const journal::JournalChecked& checked) { record_.checked(checked); }},
              sand_.allTiles(),
              record_.before().firstDifference}) {
    if (!options_.recording) {
        sand_.keepHistory(options_.record.resumed ? options_.record.resumed->material : scene.material);
    }
    if (options_.record.resumed && options_.record.resumed->outvoted) {
        check_.reportResumed(*options_.record.resumed->outvoted);
    }
    if (options_.forceShare) {
        record_.keepForce(*options_.forceShare);
    }
    if (options_.pointer) {
        barrier_.carryPointers();
    }
    if (options_.film) {
        film_.emplace(wall, options_.filmEye, options_.out);
    }
}

void Session::waitForFrame() {
    if (const std::int64_t early = clock_.begin(monotonicNs(), held()); early > 0) {
        std::this_thread::sleep_for(std::chrono::nanoseconds(early));
    }
}

ArrivedSteps Session::takeSteps() {
    // Also asked while the session is paused, so that it does not continue with an old answer about the disk.
    const bool room = record_.hasRoom(edits_.sandBytes(), sand_);
    if (!room && !desk_.paused()) {
        desk_.answerEditsThatWaitForRoom();
    }
    const std::uint64_t left = options_.steps - std::min(options_.steps, sand_.replica().stepNumber());
    const std::size_t most = held() ? 0 : std::min<std::uint64_t>(steps_->mostPerFrame(), left);
    return awaitSteps(*steps_, sand_.replica(), sand_.hash(), most, [this] { return desk_.stopAsked(); });
}

bool Session::ends() const {
    return desk_.stopAsked() || steps_->strayed() || frame_ >= options_.frames ||
           sand_.replica().stepNumber() >= options_.steps;
}

lockstep::FrameMessage Session::compose(const ArrivedSteps& steps) {
    lockstep::FrameMessage frame;
    const std::int64_t now = monotonicNs();
    frame.frame = ++frame_;
    if (options_.recording) {
        desk_.views().setHumidity(options_.recording->humidityOf(frame_));
    }
    frame.view = desk_.views().at(clock_.timeOf(frame_, now));
    frame.steps = untimed(steps);
    if (frame.view.layers.shows(lockstep::Overlay::statistics)) {
        frame.figures = measure_.figures(incidents(), sweepsOwed());
        frame.figures->dark = dark_.ranks();
    }
    const std::uint64_t shownThen = sand_.replica().stepNumber() + steps.size();
    // The ranks may still have to take the journal's sand, so the last frame comes after the replay.
    const bool last = ends() || shownThen >= options_.steps;
    frame.stop = last && check_.mayEnd(now, shownThen);
    frame.capture = film_ ? filmsFrame() : (frame.stop ? options_.pictures : desk_.needsCapture());
    // Moving sand is drawn more coarsely in pictures that are soon replaced, and in no others.
    frame.sharp = frame.capture || frame.stop || held();
    if (!frame.capture) {  // pictures show no answers
        frame.answers = desk_.windows().answers(now);
    }
    // The last frame compares the whole sand, because no later frame finds what is wrong now.
    frame.auditTiles = frame.stop ? sand_.allTiles() : sand_.auditTiles(clock_.sinceSwap(now));
    return frame;
}

void Session::startDrills() {
    for (const lockstep::Fault& fault : beginDrills(options_.drills, frame_, options_.out)) {
        steps_->drill(fault);
    }
}

/// The render ranks draw meanwhile. They swap only after the master has come to the barrier.
void Session::keep(const lockstep::FrameMessage& frame, const ArrivedSteps& steps) {
    if (frame.steps.empty() && !beginsRest()) {
        return;
    }
    const lockstep::Busy busy(barrier_, "the disk of its journal");
    std::vector<scene::Material> materials;
    for (const ArrivedStep& step : steps) {
        if (step.material) {
            materials.push_back(*step.material);
        }
    }
    record_.keep({frame.frame, sand_.hash(), frame.steps}, materials);
    keptHashOf_ = sand_.replica().stepNumber();
}

/// The hash after the last step comes with the next one otherwise, which may be made hours later.
bool Session::beginsRest() const {
    return steps_->rests() && !record_.full() && keptHashOf_ != sand_.replica().stepNumber();
}

/// A haptic server could send such steps in every frame. So the line is printed for the first one, and then whenever
/// their number is a power of two.
void Session::reportLeftOut(const ArrivedSteps& steps) {
    for (const LeftOut& one : sand_.takeLeftOut()) {
        if (one.refused) {
            steps_->refused(steps, one.what);
        }
        const std::uint64_t count = ++counted_.stepsLeftOut;
        if (std::has_single_bit(count)) {
            host::printLine("step {}: {}; all ranks leave it out, and the session continues ({} such steps so far)",
                            one.step, one.what, count);
            host::emitEvent("step_left_out", {{"step", one.step}, {"what", one.what}, {"count", count}});
        }
    }
}

void Session::reportRefusedPress(std::uint64_t before) {
    if (before == 0 && sand_.stepsUnplaced() > 0) {  // the summary has the others
        host::printLine("step {}: {}", sand_.firstStepUnplaced(), describe(refusedPressOf(sand_.replica())));
    }
}

bool Session::showFrame(bool& more) {
    waitForFrame();
    desk_.obey(barrier_.arrivals());
    desk_.followWindow(barrier_.arrivals());
    if (options_.pointer) {
        std::vector<haptic_bridge::PointerReport> pointers = barrier_.pointers();
        desk_.windows().moveView(pointers);
        desk_.windows().turnWheels(pointers);
        steps_->pointed(pointers, desk_.windows().depth(), sand_.replica(), clock_.lastSwap());
    }
    if (options_.record.check) {
        options_.record.check->requireIfCompared();
    }
    record_.keepTicks(steps_->ticks());  // before room is asked for, because ticks need it, too
    const ArrivedSteps steps = takeSteps();
    lockstep::FrameMessage composed = compose(steps);
    startDrills();
    std::size_t bytes = 0;
    const lockstep::FrameMessage frame = barrier_.begin(std::move(composed), bytes);
    const std::int64_t broadcast = monotonicNs();
    keep(frame, steps);
    const std::uint64_t unplaced = sand_.stepsUnplaced();
    sand_.apply(frame.frame, steps, frame.auditTiles, *steps_);
    reportLeftOut(steps);
    reportRefusedPress(unplaced);
    check_.applied(sand_.replica().stepNumber());
    if (!agree(frame)) {
        return false;
    }
    const Swap swap = clock_.swapped(monotonicNs());
    const haptic_bridge::Held held = heldBy();
    measure_.add({frame.frame, bytes, broadcast, swap, held, steps_->rests()}, steps, barrier_.arrivals(),
                 steps_->clockOffsetNs());
    dark_.add(barrier_.arrivals(), swap.timeNs);
    desk_.answer(steps);
    if (frame.capture && !frame.stop && !film_) {  // a film takes its own pictures
        desk_.takeCapture(frame.frame, barrier_);
    }
    steps_->shown({sand_.replica().stepNumber(), swap.interval, held, cost()});
    measure_.addHand(steps_->handed());
    if (!steps_->proveServer(steps, sand_.hash())) {
        check_.serverDiffered(frame.frame);
    }
    check_.shown(frame.frame, shownSand());
    record_.shown(swap, frame.frame, sand_, steps_->epoch());
    record_.keepIncidents(incidents(), swap.timeNs);
    more = !frame.stop;
    return true;
}

std::int32_t Session::sweepsOwed() const {
    const sand::Replica& sand = sand_.replica();
    return haptic_bridge::holdsHand(sand, options_.pace) ? sand.owed().left() : 0;
}

haptic_bridge::FrameCost Session::cost() const {
    haptic_bridge::FrameCost cost = costOf(barrier_.arrivals(), hosts_);
    cost.sweeps = sand_.work().sweeps;
    cost.substeps = sand_.work().substeps;
    cost.phases = sand_.work().phases;
    return cost;
}

bool Session::agree(const lockstep::FrameMessage& frame) {
    lockstep::Arrival mine{.frame = frame.frame,
                           .arrived = monotonicNs(),
                           .lastSwap = clock_.lastSwap(),
                           .stateHash = sand_.hash(),
                           .movement = sand_.replica().movementDigest(),
                           .viewHash = check_.viewHash(frame.view)};
    mine.dragged = sand_.time().dragNs;
    mine.slid = sand_.time().phaseNs;
    mine.swept = sand_.time().sweepNs;
    mine.hashed = sand_.time().hashNs;
    return check_.agree(frame, mine, sand_, *steps_, clock_.next(held()));
}

int Session::run() {
    bool agreed = true;
    bool shown = false;
    for (bool more = true; agreed && more;) {
        agreed = showFrame(more);
        if (agreed && !std::exchange(shown, true) && options_.firstFrameShown) {
            options_.firstFrameShown();
        }
        if (agreed) {
            printProgress(!more);
        }
        if (agreed && filmsFrame() && more) {
            film_->take(barrier_);
        }
    }
    return writeResults(agreed);
}

}  // namespace master
