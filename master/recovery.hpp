// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace master {

/// Why a session stopped before it was resumed, as its supervisor reports.
struct Failure {
    std::string what = "the start";  // for people
    std::optional<int> rank;         // that failed; nothing if it was no rank
    std::string how;                 // for programs: "SIGKILL", "status 3", "hung", "broken" or "disk"
    double noticed = 0;              // Unix time [s]; 0: when this process started
};

/// A session that has shown a frame again.
struct Recovery {
    Failure failure;
    std::uint64_t step = 0, frame = 0;  // the first that was shown
    std::uint64_t stateHash = 0;
    std::uint64_t checkpointStep = 0, replayedSteps = 0;
    std::int64_t cutBytes = 0;
};

/// Says so on standard error, with the seconds from the failure to now, and appends it to FOLDER/recoveries.jsonl. A
/// file that cannot be written is said, and nothing else.
void tellRecovery(const Recovery& recovery, const std::filesystem::path& folder);
/// The lines of FOLDER/recoveries.jsonl, each an object.
[[nodiscard]] std::vector<std::string> recoveriesOf(const std::filesystem::path& folder);
void forgetRecoveries(const std::filesystem::path& folder);

}  // namespace master
