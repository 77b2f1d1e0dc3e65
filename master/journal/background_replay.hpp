// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "master/journal/resume.hpp"
#include "sand/replica.hpp"

namespace master {

/// Replays the journal of a running session on a thread of low priority, while the session continues to write it. All
/// functions are for one other thread.
class BackgroundReplay {
public:
    /// Begins to compute the sand after step `step`, which must be in the journal on disk. Uses no checkpoint after
    /// step `newestCheckpoint`.
    BackgroundReplay(std::filesystem::path journal, std::uint64_t step, std::uint64_t newestCheckpoint);
    /// Ends the replay within one step or record.
    ~BackgroundReplay();
    BackgroundReplay(const BackgroundReplay&) = delete;
    BackgroundReplay& operator=(const BackgroundReplay&) = delete;

    /// Continues to step `step`, which must be in the journal on disk and must not be less than the step before.
    void continueTo(std::uint64_t step);

    /// Hashes that the replay has computed twice from memory.
    struct Proven {
        std::uint64_t hash = 0, movement = 0;  // Replica::stateHash(), Replica::movementDigest()
    };
    struct Progress {
        std::uint64_t step = 0;        // last step that has been replayed
        std::optional<Proven> proven;  // after the wanted step, if the replay has reached it
        std::string error;             // text that says why the replay has failed; empty if it has not
    };
    [[nodiscard]] Progress progress() const;
    /// Returns the sand after the wanted step, which the replay must have reached. Ends the replay.
    [[nodiscard]] std::unique_ptr<sand::Replica> take();

private:
    /// Thrown to end the replay.
    struct Stopped {};

    void run();
    void stop();
    /// Publishes the sand's hash, and waits for another wanted step. Returns that step.
    [[nodiscard]] std::uint64_t awaitNext(RestoredSand& restored);

    const std::filesystem::path journal_;
    const std::uint64_t newestCheckpoint_;
    mutable std::mutex mutex_;  // guards the members up to stopping_
    std::condition_variable wake_;
    std::uint64_t wanted_;
    Progress progress_;
    bool stopping_ = false;
    std::unique_ptr<sand::Replica> sand_;  // when the thread has ended
    std::thread thread_;
};

}  // namespace master
