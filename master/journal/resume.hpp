// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "journal/reader.hpp"
#include "master/journal/scene_check.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

namespace master {

/// A majority of the ranks that the replay of the journal outvotes.
struct Outvoted {
    journal::JournalDoubt majority;
    std::uint64_t rightHash = 0;  // after the same step
};

/// The sand of a session after one of its steps, computed from its journal.
struct RestoredSand {
    sand::Replica replica;
    std::uint64_t checkpointStep = 0;  // step of the checkpoint that was used; 0 for the scene itself
    std::uint64_t replayedSteps = 0;   // steps that were replayed after it
    std::int64_t volume = 0;           // with outflow, of the scene's start; every later volume is the same
    base::Bytes state;                 // of the replica, if Restoring::keepState asks for it and it is at hand
    std::optional<Outvoted> outvoted;  // if the ranks still had the sand of a wrong majority at the journal's end
};

/// Options for computing the sand from a journal.
struct Restoring {
    const base::Executor* executor = nullptr;  // see sand::Replica
    // Start of the journal's session, with Start::packed. restoreSand() takes its heights. If it is null, restoreSand()
    // reads it from the journal.
    sand::Start* start = nullptr;
    const journal::JournalReader* opened = nullptr;  // of the journal, before its first record; null: it is opened
    // Uses no checkpoint of a later step.
    std::uint64_t newestCheckpoint = std::numeric_limits<std::uint64_t>::max();
    // Another thread writes the journal. So nothing behind the wanted step is read, because it may be half written.
    bool beingWritten = false;
    bool keepState = false;  // sets RestoredSand::state, if no step is replayed after the checkpoint
    // Called after each step and after each record, with the last step; may throw to end the replay.
    std::function<void(std::uint64_t)> each{};
    // Called after each step and after each record, with the part of the records that are read and of the steps that
    // are replayed, 0 to 1. Also called with 1 when a checkpoint is left out. A replay that begins again from an
    // earlier one begins with a smaller part.
    std::function<void(double)> progress{};
};

/// A checkpoint of the last steps before a divergence may hold an error that is not in its hash yet. Fluxes show in the
/// hash one step later. No check of a majority begins with a checkpoint so young [step].
inline constexpr std::uint64_t kYoungCheckpoint = 60;
/// Returns the newest step of a checkpoint from which the decision of a majority after step `step` may be checked.
[[nodiscard]] inline std::uint64_t newestCheckpointFor(std::uint64_t step) {
    return step - std::min(step, kYoungCheckpoint);
}

/// Computes the sand after step `step` from the newest usable checkpoint at or before it and the journal's later steps.
/// `journal` is the session's file (session.journal), with the checkpoints beside it. Throws base::InputError if the
/// journal cannot be read, ends before `step`, or if the sand differs from its hashes. Any thread.
[[nodiscard]] RestoredSand restoreSand(const std::filesystem::path& journal, std::uint64_t step,
                                       const Restoring& how = {});
/// Applies the journal's steps after those of `restored` up to `step`. Throws as restoreSand() does.
void replayFurther(const std::filesystem::path& journal, std::uint64_t step, RestoredSand& restored,
                   const Restoring& how = {});

/// Gives `replica` the sand of the checkpoint `file`. `header` is the header of the session's journal, and `replica`
/// must have been made of its scene. Returns the state in the checkpoint. Throws base::FormatError if the checkpoint is
/// damaged or belongs to another session; the replica may then have any sand.
base::Bytes replaceByCheckpoint(const std::filesystem::path& file, const journal::JournalHeader& header,
                                sand::Replica& replica);

/// A session that has stopped, whose journal is open.
struct StoppedSession {
    std::filesystem::path journal;  // path of the file
    journal::JournalReader opened;  // of the journal, before its first record
    scene::Scene scene;
    std::shared_ptr<SceneCheck> check;  // of the file of the scene; never null
};

/// Opens the session in `journal` without changing it. Returns nullopt if the file does not exist. If the file `scene`
/// is named, it must describe the session's scene, which StoppedSession::check compares. `check` is called with the
/// journal before its scene is decoded, unless it is empty; it throws if the scene does not fit. Throws
/// base::InputError if the journal cannot be read.
[[nodiscard]] std::optional<StoppedSession> openSession(
    const std::filesystem::path& journal, const std::string& scene,
    const std::function<void(const journal::JournalReader&)>& check = {});

/// Everything that is needed to continue a session that has stopped, beside its scene.
struct ResumedSession {
    scene::Material material;     // with the operator's changes
    journal::JournalPlace place;  // place at which the journal continues
    std::uint64_t frame = 0;      // last frame in the journal
    std::uint32_t epoch = 0;      // last epoch in the journal
    std::uint64_t edits = 0;
    std::uint64_t lastEdit = 0;           // highest number of an edit in the journal; 0 without edits
    std::optional<double> forceShare;     // share of the force that an operator has set, 0 to 1; nullopt: none has
    std::uint64_t step = 0, hash = 0;     // last step, and the state hash after it
    std::shared_ptr<sand::Replica> sand;  // after this step; sandOf() takes it
    std::int64_t cutBytes = 0;            // [byte], behind the last whole record of the journal; ignored
    std::uint64_t checkpointStep = 0, replayedSteps = 0;
    std::optional<Outvoted> outvoted;  // if the wall had shown the sand of a wrong majority when the session stopped
};

/// Functions that resumeSession() calls with the part of some work that is done, 0 to 1. Each may be empty. Each is
/// called with 1 when its work ends. A replay that begins again calls `replayed` with a smaller part.
struct ResumeProgress {
    std::function<void(double)> read{};      // reading the records of the journal
    std::function<void(double)> replayed{};  // replaying the steps of the journal
};

/// A resumed session with the state of its sand, sand::Replica::encodeState().
struct ResumedState {
    ResumedSession session;
    base::Bytes state;
};

/// Computes the sand of `stopped` from the newest checkpoint and the later steps. `scene` is its scene, whose heights
/// it takes. `executor` is for the replica. Throws base::InputError if the session cannot be continued; the text says
/// what can be done with the journal.
[[nodiscard]] ResumedState resumeSession(const StoppedSession& stopped, scene::Scene& scene,
                                         const ResumeProgress& progress = {}, const base::Executor* executor = nullptr);

}  // namespace master
