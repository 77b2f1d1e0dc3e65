// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "haptic_bridge/client/client.hpp"

namespace haptic_bridge {

/// Hands over what the network thread receives to the callers of Client. Any thread may call every member.
///
/// `full` is true from when too much lies here until somebody drains: the network thread then reads nothing more.
class Shelf {
public:
    void tell(Link link, const std::string& message);
    [[nodiscard]] LinkStatus status() const;
    [[nodiscard]] Link link() const { return status().link; }
    /// From offered to granting, at once: a caller that polls again must not see an offer. Drops the steps that were
    /// not drained. Returns whether the link was offered; otherwise changes nothing.
    [[nodiscard]] bool beginGranting();

    /// Returns whether the shelf is full now.
    [[nodiscard]] bool add(TimedStep step);
    /// A timing test that came after step `after`.
    void addTest(std::uint32_t id, std::uint64_t after);
    void dropTests();
    /// At most `most` steps, in order. Sets `resume` when the network thread is to read on.
    [[nodiscard]] std::vector<TimedStep> drain(std::size_t most, bool& resume);
    /// Tests that came before the steps drained last, once.
    [[nodiscard]] std::vector<std::uint32_t> takeTestsInFrame();

    /// Returns whether the shelf is full since this position.
    [[nodiscard]] bool add(TimedPosition position);
    void dropPositions();
    [[nodiscard]] std::vector<TimedPosition> drainPositions(bool& resume);
    [[nodiscard]] std::uint64_t floods() const;
    [[nodiscard]] bool full() const;

    void addTicks(base::Bytes piece);
    [[nodiscard]] std::vector<base::Bytes> drainTicks();

    void keep(const Report& report);
    [[nodiscard]] std::optional<Report> report() const;
    void setClockOffset(std::int64_t ns);
    [[nodiscard]] std::int64_t clockOffsetNs() const;
    void setStepsPerSecond(std::uint32_t steps);
    [[nodiscard]] std::uint32_t stepsPerSecond() const;
    /// Calls change(counters) under the lock.
    template <class Change>
    void count(const Change& change) {
        const std::lock_guard lock(mutex_);
        change(counters_);
    }
    [[nodiscard]] LinkCounters counters() const;

private:
    mutable std::mutex mutex_;
    LinkStatus status_;
    std::deque<TimedStep> steps_;
    struct Test {
        std::uint32_t id = 0;
        std::uint64_t after = 0;  // number of the step before it
    };
    std::deque<Test> tests_;                   // that wait for a frame, as steps do
    std::vector<std::uint32_t> testsInFrame_;  // to be echoed after the next swap
    std::vector<base::Bytes> ticks_;
    std::vector<TimedPosition> positions_;
    std::uint64_t floods_ = 0;
    std::optional<Report> report_;
    LinkCounters counters_;
    std::int64_t clockOffsetNs_ = 0;
    std::uint32_t stepsPerSecond_ = 0;
    bool full_ = false;
};

}  // namespace haptic_bridge
