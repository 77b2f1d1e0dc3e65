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

/// The sand of a session after one of its steps, as its journal has it.
struct RestoredSand {
    sand::Replica terrain;
    std::uint64_t checkpointStep = 0;  // the step of the checkpoint it was computed from; 0 for the scene itself
    std::uint64_t replayedSteps = 0;   // from there
};

/// Computes the sand after `step` from the newest usable checkpoint at or before it and the journal's steps behind
/// that. `journal` is the session's file (session.journal); checkpoints lie beside it. Throws base::InputError when
/// the journal cannot be read, ends before `step`, or disagrees with the hashes it holds. Any thread.
[[nodiscard]] RestoredSand restoreSand(const std::filesystem::path& journal, std::uint64_t step,
                                       const sand::grid::Erosion::Options& sweeps = {});

/// The sand of a checkpoint, of the session with this header, whose sand began as `start`. Throws base::FormatError
/// when it is another's, or damaged.
[[nodiscard]] sand::Replica sandOfCheckpoint(const std::filesystem::path& file, const JournalHeader& header,
                                             const sand::Replica& start);

/// A session that stopped, and all that it takes to go on.
struct ResumedSession {
    scene::Scene scene;
    scene::Material material;  // with all that its operator had asked for
    JournalPlace place;        // where its journal goes on
    std::uint64_t frame = 0;   // the last in the journal
    std::uint32_t epoch = 0;   // the last
    std::uint64_t edits = 0;
    std::uint64_t step = 0, hash = 0;  // the sand
    base::Bytes state;                 // as well, sand::Replica::encodeState
    std::int64_t cutBytes = 0;         // behind the last whole record of the journal: left out
    std::uint64_t checkpointStep = 0, replayedSteps = 0;
};

/// Reads the session that `journal` holds; changes nothing. Nothing when there is none. A `scene` file that is named
/// must describe its scene. Throws base::InputError for a journal that cannot be gone on with, and says what can be
/// done with it.
[[nodiscard]] std::optional<ResumedSession> readSession(const std::filesystem::path& journal, const std::string& scene,
                                                        const sand::grid::Erosion::Options& sweeps = {});

}  // namespace master
