// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <string>

#include "host/clock.hpp"

namespace master {

/// A checkpoint that a thread writes. One thread uses the object. The destructor waits for the thread.
class UnfinishedCheckpoint {
public:
    /// Link between the object and its thread. Both functions may be called by any thread.
    class Work {
    public:
        /// Throws std::runtime_error if the checkpoint is to be left out.
        void requireWanted() const;
        /// Sets the part that is done, 0 to 1.
        void setDone(double share) { done_ = share; }

    private:
        friend class UnfinishedCheckpoint;
        std::atomic<bool> leftOut_{false};
        std::atomic<double> done_{0};
    };

    /// Calls `write` on a thread. `write` calls requireWanted() again and again, and throws if it fails.
    UnfinishedCheckpoint(std::uint64_t step, std::function<void(Work&)> write);

    /// Waits at most `patience`, and returns whether the thread has ended.
    [[nodiscard]] bool endsWithin(std::chrono::milliseconds patience) const;
    /// Asks the thread to end without a checkpoint.
    void leaveOut() { work_->leftOut_ = true; }
    /// Waits for the end of the thread. Returns why there is no checkpoint; an empty text if it is written or left out.
    /// Prints a line if it is left out. Call it once.
    [[nodiscard]] std::string complaint();

    /// Finishes the checkpoint after the last frame, when no rank waits any more. Prints a line of progress from time
    /// to time, and a line if there is no checkpoint in the end.
    ///
    /// @param dispensable  Whether the checkpoint is left out after kPatience, because an older one exists.
    /// @param abandoned    Asked about ten times a second. When it returns true, the function returns at once.
    /// @return false if the thread may still run, because the checkpoint was abandoned, or because it got no further
    ///         for kStalledSeconds. The process must then end without waiting for the thread.
    [[nodiscard]] bool finish(bool dispensable, const std::function<bool()>& abandoned,
                              const std::function<std::int64_t()>& now = host::monotonicNs);

    static constexpr std::chrono::seconds kPatience{5};
    static constexpr std::int64_t kStalledSeconds = 120;  // without a hundredth of progress

private:
    std::uint64_t step_;
    std::shared_ptr<Work> work_ = std::make_shared<Work>();
    std::future<std::string> result_;  // error message
};

/// Calls finish(). SIGINT or SIGTERM abandons the checkpoint.
[[nodiscard]] bool finishUnlessSignalled(UnfinishedCheckpoint& checkpoint, bool dispensable);

}  // namespace master
