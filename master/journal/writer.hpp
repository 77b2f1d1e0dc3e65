// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "journal/format.hpp"
#include "journal/reader.hpp"
#include "master/journal/part_file.hpp"
#include "scene/model/scene.hpp"

namespace master {

inline constexpr std::int64_t kPartBytes = 256 << 20;

/// Renames the journal of an earlier session to FILE.previous, and its parts to FILE.previous.2 and so on. Throws
/// base::InputError if this fails.
void keepPreviousJournal(const std::filesystem::path& journal);

/// Writes the steps of a session to disk before the wall shows them (docs/journal.md). Used by one thread.
///
/// If a function fails, it throws base::InputError unless it says otherwise. The file then ends with the record before,
/// and the writer must not be used again.
class JournalWriter {
public:
    /// Calls keepPreviousJournal() and makes the file with its header. When a part has grown beyond `partBytes` [byte],
    /// another part follows.
    JournalWriter(const std::filesystem::path& file, const scene::Scene& scene, const std::string& buildId,
                  std::int64_t partBytes = kPartBytes);
    /// Continues a journal at `place`, and cuts off the bytes behind it. Throws std::runtime_error as PartFile::open()
    /// does.
    JournalWriter(const journal::JournalPlace& place, const std::string& buildId, std::int64_t partBytes = kPartBytes);

    enum class Room : std::uint8_t {
        reserved,  // the next records find room on the disk
        none,      // the disk is full; a later call may find room
        unknown    // this file system cannot reserve room
    };
    /// Reserves room on the disk for `bytes` more bytes. Begins a new part if one is due. `now` is the sand after the
    /// last step that was appended. Sets `why` to the reason if there is no room.
    [[nodiscard]] Room makeRoom(std::int64_t bytes, const journal::JournalEnd& now, std::string& why);

    /// Writes the steps of a frame, and returns when they are on disk.
    void append(const journal::JournalFrame& frame);
    /// Adds any other record. It is on disk together with the next steps, or earlier if many bytes wait and the disk
    /// has room. Returns false if too many bytes of ticks wait for room, so that this piece of ticks was left out.
    bool keep(const journal::JournalRecord& record);
    void sync() { writeWaiting(); }
    /// Writes the records that wait, unless the disk is full.
    void writeIfRoom();
    /// Writes that the session was resumed here.
    void resume(const journal::JournalResumed& resumed);
    /// Writes the orderly end of the session.
    void finish(std::uint64_t step, std::uint64_t hash);

    /// Returns the random number of the session.
    [[nodiscard]] std::uint64_t session() const { return session_; }
    [[nodiscard]] std::uint32_t part() const { return part_; }
    /// Returns the part that is being written.
    [[nodiscard]] const std::filesystem::path& file() const { return file_.path(); }

private:
    void rotate(const journal::JournalEnd& now);
    void put(const journal::JournalRecord& record);
    void writeWaiting();

    std::filesystem::path journal_;  // first part of the journal
    std::string buildId_;
    std::int64_t partBytes_;
    std::uint64_t session_;
    std::uint32_t part_ = 1;
    std::uint64_t chain_ = 0;
    PartFile file_;
    base::Bytes waiting_;  // whole records that are not on disk yet
};

}  // namespace master
