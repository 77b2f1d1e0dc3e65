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
                          {"can_undo", sand.canUndo()},
                          {"sweeps_owed", sweepsOwed()},
                          {"settling", sand.settling()}};
    const Incidents all = incidents();
    host::JsonWriter writer(status);
    Incidents::counters(all, writer);
    measure_.describe(status, labels_.names);
    record_.describe(status);
    return status;
}

void Session::printProgress(bool last) {
    const std::string of = options_.steps == kNoLimit ? "" : fmt::format("/{}", options_.steps);
    measure_.printProgress(frame_, sand_.replica().stepNumber(), of, steps_->hand(), last, host::monotonicNs(),
                           options_.pointer ? Measurements::Reader::digs : Measurements::Reader::operates);
}

}  // namespace master
