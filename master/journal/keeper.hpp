// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/names.hpp"
#include "master/journal/checkpoint.hpp"
#include "master/journal/resume.hpp"
#include "master/journal/unfinished_checkpoint.hpp"
#include "master/journal/writer.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

namespace master {

/// Reaction of a session when the disk refuses to write the journal.
enum class JournalPolicy : std::uint8_t {
    required,    // the wall shows no step that is not on disk
    bestEffort,  // the session continues without a journal
    off          // the session has no journal
};
constexpr auto valuesOf(JournalPolicy) {
    return std::array{base::Named{JournalPolicy::required, "required"},
                      base::Named{JournalPolicy::bestEffort, "best-effort"}, base::Named{JournalPolicy::off, "off"}};
}

struct JournalOptions {
    JournalPolicy policy = JournalPolicy::required;
    double checkpointSeconds = 30;  // 0: no checkpoints
    std::int64_t partBytes = kPartBytes;
};

/// Error when the disk has refused steps and the policy is JournalPolicy::required.
class DiskFailure : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Writes the journal and the checkpoints of a session under a policy. Prints on standard error when the disk refuses
/// something. Main thread only.
///
/// The main thread copies the sand of a checkpoint over some frames (sand::Replica::beginCopy()), at most kCopiedCells
/// cells after each. Steps copy the sand that they change before that. Another thread compresses and writes the copy
/// when it is complete. It never reads the sand of the session.
class JournalKeeper {
public:
    /// Begins OUT/session.journal, or continues the journal of `resumed`. `failure` is what stopped the resumed
    /// session. Throws base::InputError if the journal cannot be made. Throws std::runtime_error while another session
    /// writes it, or if it has changed since it was read.
    JournalKeeper(const std::filesystem::path& out, const JournalOptions& options, const scene::Scene& scene,
                  const ResumedSession* resumed, const std::string& failure, std::string buildId);
    ~JournalKeeper();
    JournalKeeper(const JournalKeeper&) = delete;
    JournalKeeper& operator=(const JournalKeeper&) = delete;

    /// Returns whether the session may take steps of at most `bytes` bytes. It may not if the policy is required and
    /// the disk has no room for them. Called before every frame. Tries a full disk again about once per second. `now`
    /// is the sand that the wall shows. When the sand is stopped, it continues only if there is room for kResumeBytes
    /// more, because otherwise it would stop again after a few steps.
    [[nodiscard]] bool mayTake(std::int64_t bytes, const journal::JournalEnd& now);
    /// Returns whether there is room for `bytes` bytes more, for example of sand that an operator asks to load.
    /// Returns false while the sand is stopped. The answer does not stop the sand.
    [[nodiscard]] bool hasRoomFor(std::int64_t bytes, const journal::JournalEnd& now);
    static constexpr std::int64_t kResumeBytes = 1 << 20;  // [byte], of steps in about three minutes of digging
    /// Writes the steps of a frame, and returns when they are on disk. `materials` are the materials that their edits
    /// set. Throws DiskFailure if the disk refuses them and the policy is required.
    void keep(const journal::JournalFrame& frame, const std::vector<scene::Material>& materials);
    /// Writes pieces of the tick track. They are on disk together with later steps. Throws as keep() does.
    void keepTicks(const std::vector<base::Bytes>& pieces);
    /// Writes that a majority of the ranks has decided which sand is right. No checkpoint is made until checked(),
    /// because it would hold the majority's sand.
    void doubt(const journal::JournalDoubt& doubt);
    /// Writes that the majority has been compared with the journal. A checkpoint is then due.
    void checked(const journal::JournalChecked& checked);
    /// Writes the share of the force that an operator has set. It is on disk when the function returns, or with later
    /// steps if the disk is full.
    void force(const journal::JournalForce& force);
    /// Begins a checkpoint if one is due, or continues its copy. Called after every frame, when all steps of `replica`
    /// are in the journal.
    void shown(const sand::Replica& replica, std::uint64_t frame, std::uint32_t epoch, std::uint64_t hash);
    static constexpr std::int64_t kCopiedCells = std::int64_t{1} << 20;  // in a millisecond or two
    /// Copies all that a begun checkpoint lacks of `replica`, before finish().
    void copyRest(const sand::Replica& replica);
    /// Writes the end of the session. A checkpoint whose copy is not complete is left out. Between doubt() and
    /// checked() the journal gets no end. Waits at most half a second for a checkpoint that is being written, because
    /// the ranks wait meanwhile.
    void finish(const journal::JournalEnd& end);
    /// Returns the checkpoint that is still being written, for UnfinishedCheckpoint::finish(). Call it after finish().
    /// Without this call the destructor gives the checkpoint UnfinishedCheckpoint::kPatience to end.
    [[nodiscard]] std::optional<UnfinishedCheckpoint> takeUnfinished();
    /// Returns whether the session has a checkpoint on disk.
    [[nodiscard]] bool hasCheckpoint() const;

    [[nodiscard]] JournalPolicy policy() const { return options_.policy; }
    /// Returns "written", "no_room", "failed" or "off".
    [[nodiscard]] std::string_view state() const;
    [[nodiscard]] bool written() const { return writer_.has_value(); }
    [[nodiscard]] std::uint32_t parts() const { return writer_ ? writer_->part() : 0; }
    /// Returns for each checkpoint how long it delayed the frame that it delayed most [ms]. This leaves out what steps
    /// copy.
    [[nodiscard]] const std::vector<double>& copyMs() const { return copyMs_; }
    [[nodiscard]] std::uint64_t checkpointsFailed() const { return checkpointsFailed_; }
    /// Return how often, and for how long in total [s], the sand was stopped because the disk was full.
    [[nodiscard]] std::uint64_t stops() const { return stops_; }
    [[nodiscard]] double stoppedSeconds() const;
    /// Returns how many checkpoints were set aside at a resume. They are of later steps than the end of the journal,
    /// which has lost steps.
    [[nodiscard]] std::uint64_t checkpointsBeyond() const { return checkpointsBeyond_; }
    /// Returns whether finish() has written an end, and the journal has lost no steps before it.
    [[nodiscard]] bool whole() const { return ended_ && !lostSteps_; }

private:
    [[nodiscard]] bool hasRoom(std::int64_t bytes, const journal::JournalEnd& now);
    void giveUp(const std::string& why);
    void note(const journal::JournalRecord& record);
    void refused(const std::string& why);
    void requireNoWriter() const;
    void setAside(std::uint64_t step);
    void takeCheckpoint(bool wait);
    void continueCopy(const sand::Replica& replica, std::int64_t cells);
    void writeInBackground();

    JournalOptions options_;
    std::filesystem::path journal_;
    std::string buildId_;
    std::uint64_t sceneDigest_;
    std::optional<JournalWriter> writer_;    // nullopt if off or failed
    bool stopped_ = false;                   // the sand is stopped because the disk is full
    double stoppedSince_ = 0, lastTry_ = 0;  // [s]
    std::uint64_t stops_ = 0;
    double stoppedSeconds_ = 0;
    double lastCheckpoint_ = 0;  // [s]
    std::uint64_t checkpointStep_ = 0;
    /// Checkpoint whose sand is being copied.
    struct Begun {
        Checkpoint checkpoint;  // without its state
        sand::StateCopy copy;
    };
    std::optional<Begun> begun_;
    std::optional<UnfinishedCheckpoint> checkpoint_;  // the one that is being written
    std::string complaint_;                           // error message of the last checkpoint
    std::uint64_t checkpointsFailed_ = 0, checkpointsBeyond_ = 0;
    bool ticksLeftOut_ = false;
    bool doubted_ = false;
    bool ended_ = false;
    bool lostSteps_ = false;  // checkpoints of later steps were set aside, at this resume or at an earlier one
    std::vector<double> copyMs_;
};

}  // namespace master
