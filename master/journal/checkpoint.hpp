// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/byte_stream.hpp"

namespace master {

/// The whole sand after a step, beside the journal, so that a session that starts again need not replay all of it.
struct Checkpoint {
    std::uint64_t session = 0;  // whose journal it belongs to
    std::string buildId;
    std::uint64_t sceneDigest = 0;  // sand::Rules::digest of the scene
    std::uint64_t step = 0, frame = 0;
    std::uint32_t epoch = 0;
    std::uint64_t stateHash = 0;
    base::Bytes state;  // sand::Replica::encodeState

    [[nodiscard]] base::Bytes encode() const;
    /// Throws base::FormatError, in words that follow a file's name. The state is not looked into.
    static Checkpoint decode(std::span<const std::uint8_t> bytes);
};

/// FOLDER/checkpoints/STEP.checkpoint, where `journal` is FOLDER/session.journal.
[[nodiscard]] std::filesystem::path checkpointFile(const std::filesystem::path& journal, std::uint64_t step);
/// Those that lie beside the journal, the newest first: their steps.
[[nodiscard]] std::vector<std::uint64_t> checkpointsOf(const std::filesystem::path& journal);

/// Removes what a crash has left of checkpoints that were being written. While nobody writes one.
void forgetHalves(const std::filesystem::path& journal);
/// On disk when it returns, whole; then all but the newest `kept` are removed. Throws base::InputError. Any thread,
/// one at a time.
void writeCheckpoint(const std::filesystem::path& journal, const Checkpoint& checkpoint, std::size_t kept);
/// Throws base::FormatError for what cannot be read or is damaged.
[[nodiscard]] Checkpoint readCheckpoint(const std::filesystem::path& file);

}  // namespace master
