// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace master {

inline constexpr const char* kRecoveriesFile = "recoveries.jsonl";  // in the folder of a session

/// Reason why a session stopped before it was resumed. The launcher passes it on the command line.
struct Failure {
    std::string what = "the start";  // for people
    std::optional<int> rank;         // rank that failed; nullopt if no rank failed
    std::string how;                 // for programs: "SIGKILL", "status 3", "hung", "broken" or "disk"
    double noticed = 0;              // [s], when the failure was noticed, by the steady clock of `machine`
    std::string machine{};           // lockstep::machineId() of the launcher; empty if the failure was not noticed
    double before = 0;               // [s], from the failure to the start of this job, on any machine

    /// Returns how long ago the failure was noticed [s], at least 0. Without a failure, that is the start of this
    /// process. `nowNs` and `startedNs`, when this process started, are of the steady clock of the machine `here` [ns].
    /// The clock of another machine says nothing here. Then the time between the start of the job and that of this
    /// process is left out.
    [[nodiscard]] double secondsAgo(std::int64_t nowNs, std::int64_t startedNs, const std::string& here) const;
};

/// Returns the failure as the journal names it, such as "rank 3: SIGKILL". Leaves out all text that can have the name
/// of a host, because a journal is given to other people.
[[nodiscard]] std::string withoutHosts(const Failure& failure);

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
void reportRecovery(const Recovery& recovery, const std::filesystem::path& folder);
/// Returns the lines of `folder`/recoveries.jsonl. Each line is a JSON object with the fields of a recovery
/// (docs/recovery.md). Leaves out a line that is cut off. Also leaves out, and prints, a line with a value that no
/// session can write.
[[nodiscard]] std::vector<std::string> recoveriesOf(const std::filesystem::path& folder);
/// Number of the lines that recoveriesOf() returns. The launcher also appends to the file while a session runs. So the
/// file is read again when its length has changed, and not for each `ctl status`.
class RecoveryCount {
public:
    explicit RecoveryCount(const std::filesystem::path& folder) : folder_(folder) {}
    [[nodiscard]] std::size_t count();

private:
    std::filesystem::path folder_;
    std::uintmax_t bytes_ = 0;
    std::size_t count_ = 0;
};
void forgetRecoveries(const std::filesystem::path& folder);

}  // namespace master
