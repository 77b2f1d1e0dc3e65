// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "haptic_bridge/link/protocol.hpp"

namespace master {

/// What was healed or refused in a session, all its tries together: a try that is killed writes no summary.
struct Incidents {
    std::uint64_t divergences = 0, healed = 0, serverDivergences = 0;  // as in Summary
    std::uint64_t links = 0, reconnects = 0;                           // of the hand, as in LinkCounters
    haptic_bridge::RefusalCounts refusedHere{}, refused{};             // likewise
    std::uint64_t stands = 0;                                          // times that the sand stood for want of room
    friend bool operator==(const Incidents&, const Incidents&) = default;
};

/// FOLDER/incidents.json, which is rewritten whenever something was added, and read by the try that goes on.
class IncidentFile {
public:
    /// Reads what the tries before have left, of a session that goes on; what cannot be read counts as nothing, and is
    /// said.
    IncidentFile(const std::filesystem::path& folder, bool resumed);
    /// Another session's is none of this one's.
    void forget() const;

    /// Of the tries before.
    [[nodiscard]] const Incidents& before() const { return before_; }
    /// Writes them where they have changed, four times a second at most, and until it succeeds: a full disk is an
    /// incident itself.
    void keep(const Incidents& sinceTheBeginning, std::int64_t nowNs);
    /// The same at the end, at once.
    void keepLast(const Incidents& sinceTheBeginning);

private:
    void write(const Incidents& incidents);

    std::filesystem::path file_;
    Incidents before_, kept_;
    std::int64_t triedNs_ = 0;
};

}  // namespace master
