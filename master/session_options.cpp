// SPDX-License-Identifier: Apache-2.0
#include "master/session_options.hpp"

#include <algorithm>
#include <utility>

#include "master/steps/live_steps.hpp"
#include "master/steps/recorded_steps.hpp"

namespace master {
namespace {

std::vector<lockstep::Fault> faultsOf(const std::vector<Drill>& drills) {
    std::vector<lockstep::Fault> faults;
    faults.reserve(drills.size());
    for (const Drill& drill : drills) {
        faults.push_back(drill.fault);
    }
    return faults;
}

}  // namespace

SessionOptions completed(SessionOptions options) {
    if (options.recording) {
        options.record.keepsJournal = false;
        options.steps = std::min(options.steps, options.recording->lastStep());
    }
    options.desk.force = options.forceShare;
    if (!options.desk.force && options.record.resumed) {
        options.desk.force = options.record.resumed->forceShare;
    }
    return options;
}

std::unique_ptr<StepSource> stepsOf(const SessionOptions& options, const scene::Scene& scene, Edits& edits) {
    if (options.recording) {
        return std::make_unique<RecordedSteps>(options.recording, options.steps);
    }
    const ResumedSession* resumed = options.record.resumed.get();
    // A session of so many steps must not wait for a hand.
    const AtRest atRest = options.steps == kNoLimit ? AtRest::makesNone : AtRest::makesSteps;
    auto steps =
        std::make_unique<LiveSteps>(options.server, scene, edits, options.pace, resumed != nullptr ? resumed->epoch : 0,
                                    options.security, haptic_bridge::LinkClock(), atRest);
    if (options.desk.force) {
        steps->shareForce(*options.desk.force);
    }
    return steps;
}

MasterSand sandOf(const SessionOptions& options, scene::Scene& scene) {
    const ResumedSession* resumed = options.record.resumed.get();
    return resumed == nullptr
               ? MasterSand(sand::Replica::takingHeightsOf(scene, options.executor), faultsOf(options.drills))
               : MasterSand(std::move(*resumed->sand), faultsOf(options.drills), resumed->edits);
}

}  // namespace master
