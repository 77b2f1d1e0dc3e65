// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace master {

/// Reason why a session has ended itself. The launcher reads it from OUT/failure.json before it starts the session
/// again.
struct FailureReport {
    std::string what;     // "broken", "hung", "disk", "sand" or "summary"
    int rank = -1;        // 0: the master; -1: no single rank
    std::string host;     // host that the rank runs on
    std::string tile;     // name of the rank's tile; empty for the master
    std::string message;  // one line
    /// The keys of failure.json.
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("what", it.what);
        visit("rank", it.rank);
        visit("host", it.host);
        visit("tile", it.tile);
        visit("message", it.message);
    }
};

/// Emits the event `failure`, and writes failure.json whole or not at all. If it cannot be written, prints a line on
/// standard error and returns false. Any thread.
bool writeFailure(const FailureReport& failure, const std::filesystem::path& folder);

}  // namespace master
