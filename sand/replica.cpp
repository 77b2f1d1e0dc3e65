// SPDX-License-Identifier: Apache-2.0
#include "sand/replica.hpp"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/float_environment.hpp"
#include "sand/surface_factory.hpp"

namespace sand {
namespace {

std::unique_ptr<Surface> cloneOf(const Surface& surface) {
    (void)base::needDefaultFloats();  // a clone of a TIN divides volumes by areas again
    return surface.clone();
}

/// Returns the cells of the tool's centres in a step. They are those of the points of its path, and that of `before` if
/// the tool was in the sand there.
CellRect wayOf(const Step& step, const ProbePoint& before, bool wasEngaged) {
    const auto cellOf = [](const ProbePoint& at) {
        const int x = at.x >> kProbeBits, y = at.y >> kProbeBits;  // rounded down, also below zero
        return CellRect{x, y, x + 1, y + 1};
    };
    CellRect way = wasEngaged || step.path.empty() ? cellOf(before) : CellRect{};
    if (step.engaged) {
        for (const ProbePoint& at : step.path) {
            way = way.joinedWith(cellOf(at));
        }
    }
    return way;
}

/// All that the state hash covers.
struct Hashed {
    StateHead head;
    std::uint64_t sand;
    std::int64_t outflow;  // in the unit of Surface::outflow()
    std::int32_t age;      // [sweep]
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("hash version", base::constant(kHashVersion, "that of this release"));
        StateHead::members(it.head, visit);
        visit("sand", it.sand);
        visit("outflow", it.outflow);
        visit("age", it.age);
    }
};

}  // namespace

Replica::Replica(const Start& start, const base::Executor* executor) : Replica(start, makeSurface(start, executor)) {}

Replica Replica::takingHeightsOf(Start& start, const base::Executor* executor) {
    return {start, makeSurfaceOfTaken(start, executor)};
}

Replica::Replica(const Start& start, std::unique_ptr<Surface> surface)
    : rules_(start.rules),
      cellSize_(start.terrain.cellSize()),
      surface_(std::move(surface)),
      heading_(start.rules.tuning.tool.heading) {
    (void)base::needDefaultFloats();
}

Replica::Replica(const Replica& other)
    : rules_(other.rules_),
      cellSize_(other.cellSize_),
      surface_(cloneOf(*other.surface_)),
      stepNumber_(other.stepNumber_),
      probe_(other.probe_),
      heading_(other.heading_),
      engaged_(other.engaged_),
      owed_(other.owed_),
      leftOut_(other.leftOut_),
      refusedStep_(other.refusedStep_),
      refusedPress_(other.refusedPress_),
      settleCameToRest_(other.settleCameToRest_),
      lastWork_(other.lastWork_) {}

Replica& Replica::operator=(const Replica& other) { return *this = Replica(other); }

void Replica::apply(const Step& step, const std::function<void(StepPart)>& ended) {
    (void)base::needDefaultFloats();  // a driver may change the rounding of its caller at any time
    if (step.number != stepNumber_ + 1) {
        throw std::logic_error("Replica::apply: step " + std::to_string(step.number) + " after step " +
                               std::to_string(stepNumber_));
    }
    leftOut_ = whyRefused(step);
    refusedStep_ = !leftOut_.empty();
    refusedPress_ = settleCameToRest_ = false;
    lastWork_ = {};
    if (refusedStep_) {
        stepNumber_ = step.number;
        surface_->endStep(stepNumber_);
        return;
    }
    const ToolState before{rules_.tuning, probe_, heading_};
    const std::int64_t refusedBefore = surface_->refusedPresses().count;
    try {
        applyToSand(step, ended);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        skip(step, before, error.what());
    }
    refusedPress_ = surface_->refusedPresses().count != refusedBefore;
    surface_->endStep(stepNumber_);
}

void Replica::skip(const Step& step, const ToolState& before, const char* why) {
    leftOut_ = std::string("skipped: ") + why;
    stepNumber_ = step.number;
    // The sand may be half changed, and holds no copy of itself from before the step.
    const bool restored = restoreKept();
    surface_->forget();
    if (!restored) {
        surface_->reset();
    }
    rules_.tuning = before.tuning;
    surface_->changeRules(rules_);
    probe_ = before.probe;
    heading_ = before.heading;
    engaged_ = false;
    owed_ = {};
}

bool Replica::movesTool(const Step& step) const {
    const bool turns = step.heading && *step.heading != heading_;
    return step.engaged != engaged_ || (engaged_ && (turns || !step.path.empty()));
}

bool Replica::displacesSand(const Step& step) const {
    const bool otherTool = step.edit.kind == Edit::tune && step.edit.tuning.tool != rules_.tuning.tool;
    return movesTool(step) || (step.engaged && otherTool);
}

bool Replica::hasCoarsePhase(const Step& step) const {
    const Tuning& tuning = step.edit.kind == Edit::tune ? step.edit.tuning : rules_.tuning;
    return displacesSand(step) && rules_.sweepPlan(tuning).hasCoarsePhase();
}

Owed Replica::owedBy(const Step& step) const {
    if (step.edit.kind == Edit::tune) {
        const SweepPlan plan = rules_.sweepPlan(step.edit.tuning);
        return {displacesSand(step) ? plan.moved : plan.still, 0};
    }
    if (settlesBySweeps(step)) {
        return {Owed::kUntilRest, 0};
    }
    const bool endsSettle = step.edit.kind == Edit::settle || (owed_.untilRest() && movesTool(step));
    if (owed_.any() && !endsSettle) {
        return owed_;
    }
    const SweepPlan plan = rules_.sweepPlan();
    return {displacesSand(step) ? plan.moved : plan.still, 0};
}

std::int32_t Replica::mostSweeps(const Step& step) const {
    return std::min(owedBy(step).left(), rules_.stepLimits().mostSweeps);
}

std::string Replica::whyRefused(const Step& step) const {
    if (holdsTool() && movesTool(step)) {
        return "it moves the tool while " + std::to_string(owed_.left()) + " sweeps are owed";
    }
    if (const std::int32_t left = owedBy(step).left(); step.sweeps > left) {
        return "it runs " + std::to_string(step.sweeps) + " sweeps, and " + std::to_string(left) + " are owed";
    }
    return {};
}

std::int32_t Replica::wholeSweeps(const Step& step) const {
    return std::min(wholeOf(owedBy(step)), rules_.stepLimits().mostSweeps);
}

std::int32_t Replica::wholeOf(const Owed& owed) const {
    return owed.untilRest() ? std::min(std::max(settlingSweeps(), rules_.sweepPlan().still), owed.left()) : owed.left();
}

bool Replica::restoreKept() {
    try {
        if (canUndo()) {
            surface_->putBackKept();
            return true;
        }
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception&) {  // the sand from before the stroke was wrong already
        return false;
    }
    return false;
}

void Replica::applyToSand(const Step& step, const std::function<void(StepPart)>& ended) {
    lastWork_ = {0, substepsOf(step, probe_, engaged_, rules_.substepLength()), 0};
    const Owed owed = owedBy(step);
    const bool slidesCoarsely = hasCoarsePhase(step);
    const bool wasEngaged = engaged_;
    const ProbePoint before = probe_;
    const Tool toolBefore = tool();
    const bool turned = step.heading && *step.heading != heading_;
    heading_ = step.heading.value_or(heading_);
    if (step.engaged && !wasEngaged) {
        surface_->keep();
    }
    if (!step.path.empty()) {
        if (step.engaged) {
            // A tool that has just engaged only presses at its first point. It does not drag from the place where it
            // hovered.
            std::vector<ProbePoint> path{wasEngaged ? probe_ : step.path.front()};
            path.insert(path.end(), step.path.begin(), step.path.end());
            if (const std::int64_t most = rules_.mostSubsteps(); lastWork_.substeps <= most) {
                surface_->drag(tool(), path);
            } else {
                leftOut_ = "its path was left out: it has " + std::to_string(lastWork_.substeps) +
                           " sub-steps, and with this tool at most " + std::to_string(most);
                lastWork_.substeps = 0;
            }
        }
        probe_ = step.path.back();
    } else if (turned && wasEngaged && step.engaged) {
        press();  // the tool turned without moving
    }
    engaged_ = step.engaged;
    stepNumber_ = step.number;

    owed_ = owed;
    if (step.edit.kind == Edit::settle && !settling()) {
        owed_ = surface_->settle() ? owed : Owed{Owed::kUntilRest, 0};
    } else if (step.edit.kind == Edit::tune) {
        tune(step.edit.tuning);
    } else if (putBack(step.edit)) {
        return;
    }
    if (wasEngaged && (!engaged_ || turned || probe_ != before)) {
        // Sand that the tool held back may flow now.
        surface_->release(toolBefore, before);
    }
    if (engaged_ && (!wasEngaged || turned || probe_ != before)) {
        surface_->arrive(tool(), probe_);
    }
    if (wasEngaged && !engaged_) {
        surface_->leave(toolBefore);
    }
    const Tool here = tool();
    if (wasEngaged && engaged_ && step.path.empty() && !turned) {
        surface_->hold(here, probe_);
    }
    const std::int32_t sweeps = step.sweeps != 0 ? step.sweeps : wholeOf(owed_);
    ended(StepPart::movement);
    const Tool* const obstacle = engaged_ ? &here : nullptr;
    if (slidesCoarsely) {
        // A larger tool from before a tune has left sand farther away.
        const std::int32_t smaller = std::max(toolBefore.radius - here.radius, 0) / kProbePerCell;
        surface_->slideCoarsely(wayOf(step, before, wasEngaged).grownBy(2 * smaller), obstacle, probe_);
        lastWork_.phases = 1;
        ended(StepPart::coarsePhase);
    }
    const Swept swept = surface_->sweep({sweeps, owed_.done, owed_.whole}, obstacle, probe_);
    lastWork_.sweeps = swept.sweeps;
    settleCameToRest_ = swept.still && settling();
    owed_ = swept.still ? Owed{} : owed_.after(sweeps);
}

int Replica::settlingSweeps() const {
    // A step takes seconds at most, also with all processes of a wall on one host.
    constexpr std::int64_t kMostCells = std::int64_t{1} << 27;  // over which the sweeps of one step go
    constexpr std::int64_t kLeast = 16;
    const std::int64_t sweeps = std::max(kMostCells / std::max<std::int64_t>(surface_->sweepCost(), 1), kLeast);
    return static_cast<int>(std::min<std::int64_t>(sweeps, kMostSweeps));
}

void Replica::tune(const Tuning& tuning) {
    heading_ = headingAfter(rules_.tuning.tool, tuning.tool, heading_);
    const bool otherTool = tuning.tool != rules_.tuning.tool;
    rules_.tuning = tuning;
    surface_->changeRules(rules_);
    if (engaged_ && otherTool) {
        press();
    }
}

void Replica::press() {
    const std::array<ProbePoint, 2> here{probe_, probe_};
    surface_->drag(tool(), here);
}

bool Replica::putBack(const Edit& edit) {
    if (edit.kind == Edit::reset) {
        surface_->forget();  // before the sand changes, so that nothing of it is kept
        surface_->reset();
    } else if (edit.kind == Edit::undo && canUndo()) {
        surface_->putBackKept();
    } else if (edit.kind == Edit::load && edit.sand) {
        try {
            const std::shared_ptr<const SurfaceCopy> loaded = surface_->reader()(*edit.sand);
            surface_->forget();
            surface_->replace(*loaded);
        } catch (const base::FormatError& error) {  // in every replica alike
            leftOut_ = std::string("its load was ignored: ") + error.what();
            return false;
        }
    } else {
        return false;
    }
    owed_ = {};
    // The stroke of a tool that is still engaged continues. It now begins with the restored sand.
    if (engaged_) {
        surface_->keep();
        press();
    } else {
        surface_->forget();
    }
    return true;
}

std::uint64_t Replica::stateHash() {
    const Hashed hashed{head(), surface_->hash(), surface_->outflow(), surface_->age()};
    const base::Bytes bytes = base::encoded(hashed);
    return XXH3_64bits(bytes.data(), bytes.size());
}

std::uint64_t Replica::movementDigest() const {
    const Movement* const movement = surface_->movement();
    return movement == nullptr ? 0 : movement->digest();
}

}  // namespace sand
