// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/field_forms.hpp"
#include "journal/file_origin.hpp"
#include "sand/replica.hpp"

namespace master {

/// The whole sand after a step, in a file beside the journal. With it, a resumed session need not replay the whole
/// journal.
struct Checkpoint {
    std::uint64_t session = 0;  // session whose journal it belongs to
    std::string buildId;
    std::uint64_t sceneDigest = 0;  // sand::Rules::digest() of the scene
    std::uint64_t step = 0, frame = 0;
    std::uint32_t epoch = 0;
    std::uint64_t stateHash = 0;
    base::Bytes state;  // sand::Replica::encodeState()

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("session", it.session);
        visit("build", base::text(it.buildId, journal::kLongestBuild));
        visit("scene_digest", it.sceneDigest);
        visit("step", it.step);
        visit("frame", it.frame);
        visit("epoch", it.epoch);
        visit("state_hash", it.stateHash);
        visit("state", base::block(it.state));
    }
    [[nodiscard]] base::Bytes encode() const;
    /// Throws base::FormatError if the bytes are damaged or of another release. The caller puts the file's name before
    /// the text. Does not decode the state.
    static Checkpoint decode(std::span<const std::uint8_t> bytes);
};

/// Returns FOLDER/checkpoints/STEP.checkpoint, where `journal` is FOLDER/session.journal.
[[nodiscard]] std::filesystem::path checkpointFile(const std::filesystem::path& journal, std::uint64_t step);
/// Returns the steps of the checkpoints beside `journal`, the newest first.
[[nodiscard]] std::vector<std::uint64_t> checkpointsOf(const std::filesystem::path& journal);

/// Removes the unfinished checkpoints that a crash has left. Call it while no checkpoint is being written.
void forgetHalves(const std::filesystem::path& journal);
/// Writes a checkpoint, which is whole and on disk when the function returns. Then removes all but the newest `kept`
/// checkpoints. Throws base::InputError if the disk refuses it. Any thread, but only one at a time.
void writeCheckpoint(const std::filesystem::path& journal, const Checkpoint& checkpoint, std::size_t kept);
/// Writes `checkpoint` with the state `copy` instead of its own. Needs memory for a stripe of the sand, because it
/// writes the file while it compresses the state. `copy` must be complete. `done` is called after each stripe, and
/// while the file is read again, with the part of the work that is done, 0 to 1. It may throw, and no checkpoint is
/// then written.
void writeCheckpoint(const std::filesystem::path& journal, const Checkpoint& checkpoint, const sand::StateCopy& copy,
                     std::size_t kept, const std::function<void(double share)>& done);
/// Reads a file of checkpointFile(). Throws base::FormatError if the file or its folder is a link, or the file cannot
/// be read or is damaged.
[[nodiscard]] Checkpoint readCheckpoint(const std::filesystem::path& file);

}  // namespace master
