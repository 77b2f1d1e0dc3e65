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

/// Place where the network thread leaves what it has received for the callers of Client. Any thread may call every
/// member.
///
/// The shelf is full from the moment when too many steps or positions wait until a caller drains them. Meanwhile the
/// network thread does not read.
class Shelf {
public:
    /// Sets the state of the link and its message. A change of either counts as a new message to print.
    void setStatus(Link link, const std::string& message);
    /// Sets how much of its scene the server has read.
    void setLoaded(std::uint32_t done);
    [[nodiscard]] LinkStatus status() const;
    [[nodiscard]] Link link() const { return status().link; }
    /// Changes the link from offered to granting at once, so that a caller that polls again does not see an offer.
    /// Drops the steps that were not drained. Returns false, and leaves the link unchanged, if the link was not
    /// offered.
    [[nodiscard]] bool beginGranting();

    /// Notes that the server needs the whole sand, until the link has another state.
    void askForState();
    [[nodiscard]] bool needsState() const;
    /// Returns needsState(), which is false from then on.
    [[nodiscard]] bool beginGivingState();

    /// Adds a step. Returns whether the shelf is full now.
    [[nodiscard]] bool add(TimedStep step);
    /// Adds timing test `id`, which came after step `after`.
    void addTest(std::uint32_t id, std::uint64_t after);
    void dropTests();
    /// Returns at most `most` steps, in order. Sets `resume` to true if the network thread must continue to read.
    [[nodiscard]] std::vector<TimedStep> drain(std::size_t most, bool& resume);
    /// Returns each test that came before the steps drained last, once.
    [[nodiscard]] std::vector<std::uint32_t> takeTestsInFrame();

    /// Adds a position. Returns true if the shelf has become full with it.
    [[nodiscard]] bool add(TimedPosition position);
    void dropPositions();
    [[nodiscard]] std::vector<TimedPosition> drainPositions(bool& resume);
    [[nodiscard]] std::uint64_t floods() const;
    [[nodiscard]] bool full() const;

    void addTicks(base::Bytes piece);
    [[nodiscard]] std::vector<base::Bytes> drainTicks();

    void keep(const Report& report);
    [[nodiscard]] std::optional<Report> report() const;
    /// Keeps why the last attempt to link has failed.
    void fail(const std::string& why);
    [[nodiscard]] std::string failure() const;
    /// Called when a handshake has succeeded. Forgets the failure before it, and the audit of the link before.
    void linked();
    void setClockOffset(std::int64_t ns);
    [[nodiscard]] std::int64_t clockOffsetNs() const;
    void setStepsPerSecond(std::uint32_t steps);
    [[nodiscard]] std::uint32_t stepsPerSecond() const;
    void setForceCeiling(double share);
    /// Returns the ceiling of the linked server; nullopt unless the link is `linked`.
    [[nodiscard]] std::optional<double> forceCeiling() const;
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
    bool needsState_ = false;
    std::deque<TimedStep> steps_;
    struct Test {
        std::uint32_t id = 0;
        std::uint64_t after = 0;  // number of the step before the test
    };
    std::deque<Test> tests_;                   // tests that wait for a frame, as steps do
    std::vector<std::uint32_t> testsInFrame_;  // ids of tests to be answered after the next swap
    std::vector<base::Bytes> ticks_;
    std::size_t tickBytes_ = 0;  // [byte] of ticks_
    std::vector<TimedPosition> positions_;
    std::uint64_t floods_ = 0;
    std::optional<Report> report_;
    std::string failure_;
    LinkCounters counters_;
    std::int64_t clockOffsetNs_ = 0;
    std::uint32_t stepsPerSecond_ = 0;
    double forceCeiling_ = 1;
    bool full_ = false;
};

}  // namespace haptic_bridge
