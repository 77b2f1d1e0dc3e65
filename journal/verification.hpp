// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "journal/format.hpp"
#include "sand/replica.hpp"

namespace journal {

/// Replays a session record by record, and compares its hashes with those of the replay. Used by one thread.
class Verification {
public:
    /// Called after each step.
    using AfterStep = std::function<void(sand::Replica&)>;
    /// A hash in the journal that differs from the replay's.
    struct Difference {
        JournalEnd recorded;
        std::uint64_t replayed = 0;
    };
    struct Counts {
        std::uint64_t records = 0, ticks = 0, resumes = 0;
        std::uint64_t hashes = 0, differing = 0;  // hashes that count, and those of them that differ
        std::uint64_t doubts = 0, outvoted = 0;   // majorities, and those of them that the replay outvotes
        std::uint64_t firstFrame = 0, lastFrame = 0;
        std::uint32_t lastEpoch = 0;
        std::uint64_t leftOut = 0;  // steps
        std::string firstLeftOut;   // the first of them with its reason; empty if there is none
        std::int64_t cutBytes = 0;  // [byte], cut off by resumes
        std::optional<Difference> firstDifference;
        std::optional<JournalEnd> end;  // nullopt if the session was cut off
    };

    /// `start` is the sand before the first step. `name` is the journal's name for messages.
    Verification(std::string name, const sand::Replica& start) : name_(std::move(name)), replica_(start) {}

    /// Applies the steps of the next record, and compares its hashes. Throws base::InputError if a step is missing.
    void take(const JournalRecord& record, const AfterStep& afterStep = {});

    [[nodiscard]] const Counts& counts() const { return counts_; }
    /// Returns the sand after the last step.
    [[nodiscard]] sand::Replica& replica() { return replica_; }
    [[nodiscard]] const sand::Replica& replica() const { return replica_; }

private:
    struct Visitor;
    void compare(const JournalEnd& recorded);

    std::string name_;
    sand::Replica replica_;
    Counts counts_;
};

}  // namespace journal
