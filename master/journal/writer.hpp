// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "master/journal/format.hpp"
#include "master/journal/part_file.hpp"
#include "master/journal/reader.hpp"
#include "scene/scene.hpp"

namespace master {

inline constexpr std::int64_t kPartBytes = 256 << 20;

/// What a session before has left goes out of the way: its journal becomes FILE.previous, its parts FILE.previous.2 and
/// so on. Throws base::InputError.
void keepPreviousJournal(const std::filesystem::path& journal);

/// Writes a session to disk before the wall shows it (docs/journal.md). One thread.
///
/// What throws, throws base::InputError; the file then ends with the record before, and the writer is to be left
/// alone.
class JournalWriter {
public:
    /// Makes the file, header and all, after keepPreviousJournal(). A part that has grown beyond `partBytes` is
    /// followed by another.
    JournalWriter(const std::filesystem::path& file, const scene::Scene& scene, const std::string& buildId,
                  std::int64_t partBytes = kPartBytes);
    /// Goes on behind a whole record; what stands there is cut off. Throws std::runtime_error as PartFile::open.
    JournalWriter(const JournalPlace& place, const std::string& buildId, std::int64_t partBytes = kPartBytes);

    enum class Room : std::uint8_t {
        reserved,  // what is appended next cannot find the disk full
        none,      // it can be tried again
        unknown    // this file system reserves nothing
    };
    /// Asks the file system for room for so many bytes more, before anybody relies on it; begins a new part where it
    /// is time to. `now` is the sand after the last step that was appended. `why` says what is in the way.
    [[nodiscard]] Room makeRoom(std::int64_t bytes, const JournalEnd& now, std::string& why);

    /// Returns when the steps are on disk.
    void append(const JournalFrame& frame);
    /// Anything else: on disk with the next steps, or when there is much of it and room. False when so much waits for
    /// room that this was left out.
    bool keep(const JournalRecord& record);
    void sync() { writeWaiting(); }
    /// The session goes on here, having stopped.
    void resume(const JournalResumed& resumed);
    /// The session ended here, on purpose.
    void finish(std::uint64_t step, std::uint64_t hash);

    /// A number that no other session has.
    [[nodiscard]] std::uint64_t session() const { return session_; }
    [[nodiscard]] std::uint32_t part() const { return part_; }
    /// What is written now.
    [[nodiscard]] const std::filesystem::path& file() const { return file_.path(); }

private:
    void rotate(const JournalEnd& now);
    void put(const JournalRecord& record);
    void writeWaiting();

    std::filesystem::path journal_;  // its first part
    std::string buildId_;
    std::int64_t partBytes_;
    std::uint64_t session_;
    std::uint32_t part_ = 1;
    std::uint64_t chain_ = 0;
    PartFile file_;
    base::Bytes waiting_;  // whole records that are not on disk
};

}  // namespace master
