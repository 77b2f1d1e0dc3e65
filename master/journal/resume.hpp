// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "master/journal/reader.hpp"
#include "sand/replica.hpp"
#include "scene/scene.hpp"

namespace master {

/// The sand of a session after one of its steps, computed from its journal.
struct RestoredSand {
    sand::Replica terrain;
    std::uint64_t checkpointStep = 0;  // step of the checkpoint that was used; 0 for the scene itself
    std::uint64_t replayedSteps = 0;   // steps that were replayed after it
};

/// Computes the sand after step `step` from the newest usable checkpoint at or before it and the journal's later steps.
/// `journal` is the session's file (session.journal), with the checkpoints beside it. Throws base::InputError if the
/// journal cannot be read, ends before `step`, or if the sand differs from its hashes. Any thread.
[[nodiscard]] RestoredSand restoreSand(const std::filesystem::path& journal, std::uint64_t step,
                                       const sand::grid::Erosion::Options& sweeps = {});

/// Returns the sand of the checkpoint `file`. `header` is the header of the session's journal, and `start` the sand at
/// its start. Throws base::FormatError if the checkpoint is damaged or belongs to another session.
[[nodiscard]] sand::Replica sandOfCheckpoint(const std::filesystem::path& file, const JournalHeader& header,
                                             const sand::Replica& start);

/// A session that has stopped, with everything that is needed to continue it.
struct ResumedSession {
    scene::Scene scene;
    scene::Material material;  // with the operator's changes
    JournalPlace place;        // place at which the journal continues
    std::uint64_t frame = 0;   // last frame in the journal
    std::uint32_t epoch = 0;   // last epoch in the journal
    std::uint64_t edits = 0;
    std::uint64_t step = 0, hash = 0;  // last step, and the state hash after it
    base::Bytes state;                 // sand::Replica::encodeState() after this step
    std::int64_t cutBytes = 0;         // [byte], behind the last whole record of the journal; ignored
    std::uint64_t checkpointStep = 0, replayedSteps = 0;
};

/// Reads the session in `journal` without changing it. Returns nullopt if the file does not exist. If the file `scene`
/// is named, it must describe the session's scene. Throws base::InputError if the session cannot be continued; the text
/// says what can be done with the journal.
[[nodiscard]] std::optional<ResumedSession> readSession(const std::filesystem::path& journal, const std::string& scene,
                                                        const sand::grid::Erosion::Options& sweeps = {});

}  // namespace master
