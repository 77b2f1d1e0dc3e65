// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "base/field_forms.hpp"
#include "haptic_bridge/link/protocol.hpp"

namespace master {

/// Counts of the incidents of a session, including the time before its restarts. A process that is killed writes no
/// summary, so these counts have a file of their own.
struct Incidents {
    std::uint64_t divergences = 0;                          // frames in which the ranks' sand or views differed
    std::uint64_t healed = 0;                               // times that a rank was healed
    std::uint64_t outvoted = 0;                             // times that the journal outvoted a majority of the ranks
    std::uint64_t serverDivergences = 0;                    // frames in which the haptic server's sand differed
    std::uint64_t stepsLeftOut = 0;                         // steps with a sand::Replica::leftOut()
    std::uint64_t stepsUnplaced = 0;                        // steps with a sand::Replica::refusedPress()
    std::uint64_t links = 0, reconnects = 0;                // of the haptic link, see LinkCounters
    haptic_bridge::RefusalCounts refusedHere{}, refused{};  // of the haptic link, see LinkCounters
    std::uint64_t stops = 0;                                // times that the sand was stopped because the disk was full
    std::uint64_t firstDifference = 0;                      // first frame in which sand or a view differed; 0: none

    /// Returns firstDifference; nullopt if it is 0.
    [[nodiscard]] std::optional<std::uint64_t> firstFrame() const {
        return firstDifference == 0 ? std::nullopt : std::optional(firstDifference);
    }

    /// The counters that incidents.json, summary.json and `ctl status` contain under the same keys.
    template <class Self, class Visit>
    static void counters(Self& it, Visit& visit) {
        visit("divergences", it.divergences);
        visit("healed", it.healed);
        visit("outvoted", it.outvoted);
        visit("server_divergences", it.serverDivergences);
        visit("steps_left_out", it.stepsLeftOut);
        visit("steps_unplaced", it.stepsUnplaced);
    }
    /// The keys of incidents.json. Summary::fields() has the keys of summary.json for those below counters().
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        counters(it, visit);
        visit("links", it.links);
        visit("reconnects", it.reconnects);
        visit("stands", it.stops);
        visit("first_difference", it.firstDifference);
        visit("refused_by_server", base::byName<haptic_bridge::RefusalCode>(it.refusedHere));
        visit("refused", base::byName<haptic_bridge::RefusalCode>(it.refused));
    }
    friend bool operator==(const Incidents&, const Incidents&) = default;
};

/// The file FOLDER/incidents.json. It is rewritten when the counts have changed, and read when the session is resumed.
class IncidentFile {
public:
    /// Reads the counts from before the restart if the session is `resumed`. If the file is damaged or holds a number
    /// that is no count, prints a line and starts at 0.
    IncidentFile(const std::filesystem::path& folder, bool resumed);
    /// Removes the file, which belongs to an earlier session.
    void forget() const;

    /// Returns the counts from before the last restart.
    [[nodiscard]] const Incidents& before() const { return before_; }
    /// Writes the counts if they have changed, at most four times per second. If that fails, prints it once and tries
    /// again in later calls, because a full disk is itself an incident.
    void keep(const Incidents& sinceTheBeginning, std::int64_t nowNs);
    /// Writes the counts at the end of the session, at once, if they have changed.
    void keepLast(const Incidents& sinceTheBeginning);

private:
    void write(const Incidents& incidents);

    std::filesystem::path file_;
    Incidents before_, kept_;
    std::int64_t triedNs_ = 0;
    bool printedFailure_ = false;  // since the last write that succeeded
};

}  // namespace master
