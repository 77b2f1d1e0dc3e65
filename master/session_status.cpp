// SPDX-License-Identifier: Apache-2.0
// The status of a running session. Operators, the log and the file of incidents show it.
#include <fmt/format.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "host/clock.hpp"
#include "host/json_fields.hpp"
#include "master/session.hpp"

namespace master {

Incidents Session::incidents() const {
    Incidents all = counted_;
    all.firstDifference = check_.firstDifference();
    all.stops += record_.stops();
    all.stepsUnplaced += sand_.stepsUnplaced();
    const haptic_bridge::LinkCounters link = steps_->counters();
    all.links += link.links;
    all.reconnects += link.reconnects;
    for (std::size_t i = 0; i < all.refused.size(); ++i) {
        all.refusedHere[i] += link.refusedHere[i];
        all.refused[i] += link.refused[i];
    }
    return all;
}

nlohmann::json Session::status() const {
    const sand::Replica& sand = sand_.replica();
    const scene::UndoHistory* const history = sand_.history();
    const std::size_t undos = history != nullptr ? history->entries().undosLeft() : 0;
    nlohmann::json status{{"frame", frame_},
                          {"step", sand.stepNumber()},
                          {"ranks", wall_.ranks()},
                          {"linked", steps_->linked()},
                          {"streaming", steps_->streaming()},
                          {"force_tripped", steps_->forceTripped()},
                          {"tool_radius", sand.toolRadius()},
                          {"tool_shape", std::string(base::nameOf(sand.tool().kind))},
                          {"tool_heading", sand::degreesOf(sand.heading())},
                          {"state_hash", fmt::format("{:016x}", sand_.hash())},
                          {"checking_journal", check_.pending()},
                          {"edits", sand_.edits()},
                          {"can_undo", undos > 0},
                          {"undo_left", undos},
                          {"redo_left", history != nullptr ? history->entries().redosLeft() : 0},
                          {"sweeps_owed", sweepsOwed()},
                          {"settling", sand.settling()},
                          {"resting", steps_->rests()}};
    const Incidents all = incidents();
    host::JsonWriter writer(status);
    Incidents::counters(all, writer);
    status["dark"] = dark_.names();
    measure_.describe(status, labels_.names);
    record_.describe(status);
    return status;
}

/// The log of an untouched wall must stay short. The launcher takes a haptic server for hung that has had no link
/// for 10 s, as far as it knows from the events.
double Session::secondsToRepeat() const {
    constexpr double kRarely = 60, kOften = 5, kAlways = 1;
    return !options_.server ? kRarely : steps_->rests() ? kOften : kAlways;
}

void Session::printProgress(bool last) {
    measure_.printProgress({.frame = frame_,
                            .step = sand_.replica().stepNumber(),
                            .of = options_.steps == kNoLimit ? "" : fmt::format("/{}", options_.steps),
                            .hand = steps_->hand(),
                            .last = last,
                            .repeat = secondsToRepeat()},
                           host::monotonicNs(),
                           options_.pointer ? Measurements::Reader::digs : Measurements::Reader::operates);
}

}  // namespace master
