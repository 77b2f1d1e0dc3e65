// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace master {

/// Reason why a session stopped before it was resumed. The launcher passes it on the command line.
struct Failure {
    std::string what = "the start";  // for people
    std::optional<int> rank;         // rank that failed; nullopt if no rank failed
    std::string how;                 // for programs: "SIGKILL", "status 3", "hung", "broken" or "disk"
    double noticed = 0;              // Unix time [s] at which the failure was noticed; 0: when this process started
};

/// Return of a session to work: the first frame that it shows after a failure.
struct Recovery {
    Failure failure;
    std::uint64_t step = 0, frame = 0;  // first step and frame that were shown
    std::uint64_t stateHash = 0;
    std::uint64_t checkpointStep = 0, replayedSteps = 0;
    std::int64_t cutBytes = 0;
};

/// Prints the recovery on standard error, with the time since the failure [s], emits the event `recovered`, and appends
/// it to `folder`/recoveries.jsonl. If the file cannot be written, prints this and continues.
void tellRecovery(const Recovery& recovery, const std::filesystem::path& folder);
/// Returns the lines of `folder`/recoveries.jsonl. Each line is a JSON object.
[[nodiscard]] std::vector<std::string> recoveriesOf(const std::filesystem::path& folder);
void forgetRecoveries(const std::filesystem::path& folder);

}  // namespace master
