// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "files/byte_stream.hpp"
#include "sand/scene.hpp"
#include "sand/step.hpp"

namespace master {

/// The steps of one frame, as the journal holds them.
struct JournalFrame {
    std::uint64_t frame = 0;
    std::uint64_t hashBefore = 0;  // state hash before the first of the steps
    std::vector<sand::Step> steps;
};

/// Writes a session to disk before the wall shows it (docs/journal.md). One thread.
class JournalWriter {
public:
    /// Makes the file, header and all; a journal that is there already is kept as FILE.previous. Throws
    /// files::InputError when the file cannot be made.
    JournalWriter(const std::filesystem::path& file, const sand::Scene& scene, const std::string& buildId);
    ~JournalWriter();
    JournalWriter(const JournalWriter&) = delete;
    JournalWriter& operator=(const JournalWriter&) = delete;

    /// Returns when the steps are on disk. Throws files::InputError when the disk refuses them: the file then ends with
    /// the frame before, and is to be left alone.
    void append(const JournalFrame& frame);
    /// A piece of the haptic server's tick track: on disk with the next steps, or when there is much of it. Throws as
    /// append() does.
    void keepTicks(const files::Bytes& piece);
    /// The session ended here, on purpose.
    void finish(std::uint64_t step, std::uint64_t hash);

private:
    void appendRecord(std::uint8_t type, const files::Bytes& payload);
    void putRecord(std::uint8_t type, const files::Bytes& payload);
    void writeWaiting();
    void writeAll(const files::Bytes& bytes);

    std::filesystem::path file_;
    int descriptor_ = -1;
    std::int64_t size_ = 0;  // [byte], of what is on disk, whole
    files::Bytes waiting_;   // whole records that are not
};

/// What the last record of a whole session holds.
struct JournalEnd {
    std::uint64_t step = 0, hash = 0;
};

/// A session read back.
struct Journal {
    sand::Scene scene;
    std::string buildId;
    std::vector<JournalFrame> frames;
    std::vector<files::Bytes> ticks;  // pieces of the haptic server's tick track, when it recorded
    std::optional<JournalEnd> end;    // absent when the session was cut off
    std::int64_t tornBytes = 0;       // at the end of the file, behind the last whole record; left out
};

/// Throws files::InputError for a file that is missing, no journal, of another version, or damaged before its end.
[[nodiscard]] Journal readJournal(const std::filesystem::path& file);

}  // namespace master
