// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "sand/terrain.hpp"

namespace master {

/// The sand of a session after one of its steps, as its journal has it.
struct RestoredSand {
    sand::Terrain terrain;
    std::uint64_t checkpointStep = 0;  // the step of the checkpoint it was computed from; 0 for the scene itself
    std::uint64_t replayedSteps = 0;   // from there
};

/// Computes the sand after `step` from the newest usable checkpoint at or before it and the journal's steps behind
/// that. `journal` is the session's file (session.journal); checkpoints lie beside it. Throws files::InputError when
/// the journal cannot be read, ends before `step`, or disagrees with the hashes it holds. Any thread.
[[nodiscard]] RestoredSand restoreSand(const std::filesystem::path& journal, std::uint64_t step,
                                       const sand::Erosion::Options& sweeps = {});

}  // namespace master
