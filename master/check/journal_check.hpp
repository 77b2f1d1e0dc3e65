// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "master/check/decision.hpp"
#include "master/journal/background_replay.hpp"
#include "master/measure/incidents.hpp"
#include "sand/replica.hpp"

namespace master {

/// Compares the decisions of a majority of the ranks with the journal (docs/healing.md). The wall continues with the
/// majority's sand meanwhile. If the replay of the journal disagrees, it catches up with the wall, and all ranks take
/// its sand. Used by one thread.
class JournalCheck {
public:
    /// Functions that write to the journal.
    struct Record {
        std::function<std::filesystem::path()> journal;  // its first file; an empty path without a journal
        std::function<void(const journal::JournalDoubt&)> doubt;
        std::function<void(const journal::JournalChecked&)> checked;
    };
    /// `out` gets divergence.txt. `incidents` counts the majorities that the journal outvotes.
    JournalCheck(Record record, std::filesystem::path out, Incidents& incidents);

    /// If the replay is no more than so many steps behind the wall, the wall takes no steps until the replay is there.
    static constexpr std::uint64_t kShortWay = 60;
    /// A replay that fails is begun again, at most so often in all.
    static constexpr int kTries = 3;

    /// Begins to check what a majority has decided in frame `frame`. Without a journal does nothing. All steps up to
    /// that of the decision must be in the journal.
    void begin(std::uint64_t frame, const Decision& decision);
    /// Called in every frame before the ranks meet. `step` is the last step of the frame, which is in the journal.
    /// Returns the journal's sand after this step if all ranks must take it; null otherwise.
    [[nodiscard]] std::unique_ptr<sand::Replica> rightSand(std::uint64_t step);
    /// Called in every frame after all ranks agreed on the sand `shown`. Compares the replay with the majority as soon
    /// as the replay has reached the majority's step.
    void look(std::uint64_t frame, const journal::JournalEnd& shown);
    /// Called when all ranks have the sand that rightSand() has returned.
    void taken(std::uint64_t frame, const journal::JournalEnd& shown);
    /// Called after the last frame, when no rank can take other sand any more. Waits at most `patience` for the replay.
    /// failed() then returns false if the session's sand is confirmed.
    void finish(std::uint64_t frame, const journal::JournalEnd& shown, std::chrono::milliseconds patience);
    /// Counts and reports a majority that the replay outvoted when the session was resumed.
    void reportResumed(const Outvoted& outvoted);

    /// Returns whether a majority's decision has not been compared yet, or the ranks must still take other sand.
    [[nodiscard]] bool pending() const { return replay_ != nullptr || taking_; }
    /// Returns whether rightSand() has returned sand and taken() has not been called since.
    [[nodiscard]] bool taking() const { return taking_; }
    /// Returns whether the wall must take no steps, so that the replay can catch up with it.
    [[nodiscard]] bool holds() const { return holds_; }
    /// Returns whether the latest decision could not be compared, so that the sand may be wrong.
    [[nodiscard]] bool failed() const { return !doubt_.empty(); }
    /// Returns why failed() is true, such as "its journal could not be replayed"; an empty text if it is false.
    [[nodiscard]] const std::string& doubt() const { return doubt_; }
    /// Returns the step that the replay has reached, for people.
    [[nodiscard]] std::uint64_t step() const { return replay_ ? replay_->progress().step : 0; }

private:
    void start();
    void compare(std::uint64_t frame, const BackgroundReplay::Proven& replayed, const journal::JournalEnd& shown);
    void fail(std::uint64_t frame, const std::string& error);
    void report(std::uint64_t frame, const char* state, std::uint64_t rightHash, const std::string& line) const;

    const Record record_;
    const std::filesystem::path out_;
    Incidents& incidents_;
    journal::JournalDoubt majority_;  // its latest decision
    std::uint64_t movement_ = 0;      // of the same decision
    std::unique_ptr<BackgroundReplay> replay_;
    bool wrong_ = false;           // the journal disagrees with majority_
    std::uint64_t rightHash_ = 0;  // after the step of majority_
    bool holds_ = false, taking_ = false;
    std::string doubt_;      // why the latest decision is in doubt; empty if it is not
    std::uint64_t way_ = 0;  // [step], by which the replay was behind when it last set out
    int tries_ = 0;
};

}  // namespace master
