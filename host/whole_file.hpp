// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
#include <string>

namespace host {

/// File that is written completely or not at all. keep() replaces the previous file at its path.
///
/// The text goes into a temporary file in the same folder. keep() renames it; without keep() the destructor removes it,
/// and a failure removes it at once.
/// Never follows a symbolic link, except /dev/stdout, /dev/stderr and /dev/fd/N, and never lets group or other users
/// write to the file. Throws base::InputError in one line if the path cannot be written.
class WholeFile {
public:
    /// What to do with a path that is not a regular file, such as a pipe.
    enum class Other {
        written,  // it is written to directly, which may wait for a reader; for files that a user names
        refused   // for the files of a running session, which must not wait
    };
    explicit WholeFile(const std::filesystem::path& path, Other other = Other::written);
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    [[nodiscard]] std::ostream& stream() { return stream_; }
    /// Calls `take` with all that was written so far, piece by piece. Only for a path that is a regular file or is not
    /// there yet. Throws base::InputError if it cannot be read.
    void readBack(const std::function<void(std::span<const std::uint8_t>)>& take);
    void keep();
    /// Does what keep() does, and returns when the file is on disk, where it survives a power loss.
    void keepSynced();

private:
    [[noreturn]] void fail();
    void removePart();

    std::filesystem::path path_;    // as the user gave it
    std::filesystem::path beside_;  // temporary file; empty if path_ is written to directly
    int descriptor_ = -1;           // of the temporary file, or of the pipe or device
    std::ofstream stream_;
};

/// Throws base::InputError if `path` cannot be written, as WholeFile does, for example before hours of work. Never
/// opens a pipe, because its reader would take the close for the end of the file.
void requireWritable(const std::filesystem::path& path);

/// Syncs the folder of `file`, so that created and removed names survive a power loss. Returns false with errno if that
/// fails. Returns true if the folder must not be read, and on file systems that cannot sync a folder.
bool syncFolderOf(const std::filesystem::path& file);

}  // namespace host
