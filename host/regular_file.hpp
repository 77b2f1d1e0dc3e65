// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace host {

/// A regular file that is open for reading. Opening never waits: it refuses a pipe, which could wait without end for a
/// writer, and also a device, a socket and a folder. Used by one thread.
class RegularFile {
public:
    /// Whether a symbolic link is followed. It is refused where the path is inside a session's folder.
    enum class Links { followed, refused };
    /// Opens `path`. If that fails, error() is the reason.
    explicit RegularFile(const std::filesystem::path& path, Links links = Links::followed);
    /// Opens the file `inside`, such as "saves/a.sand", of a session's folder. A link may lead to the folder itself. In
    /// the folder, no link is followed, neither to a folder nor to the file.
    RegularFile(const std::filesystem::path& folder, const std::filesystem::path& inside);
    ~RegularFile();
    RegularFile(const RegularFile&) = delete;
    RegularFile& operator=(const RegularFile&) = delete;

    /// Returns why the file is not open, such as "is not a regular file"; an empty text if it is open.
    [[nodiscard]] const std::string& error() const { return error_; }
    [[nodiscard]] std::uintmax_t size() const;  // [byte], when it was opened
    /// Returns why other users may read or change the file, or own it; an empty text if only this process's user may.
    [[nodiscard]] std::string whyNotPrivate() const;
    /// Returns the first `most` bytes, or all if the file is shorter. Returns nullopt if the disk fails.
    [[nodiscard]] std::optional<std::vector<std::uint8_t>> read(std::size_t most) const;
    /// Sets `bytes` to `size` bytes from `offset` [byte] on, or to fewer at the end of the file. Returns false if the
    /// disk fails.
    [[nodiscard]] bool readAt(std::uint64_t offset, std::size_t size, std::vector<std::uint8_t>& bytes) const;

private:
    /// Takes the result of an open(), whose errno is still set if it has failed.
    void take(int descriptor, bool linksRefused);

    int descriptor_ = -1;
    struct stat about_ {};
    std::string error_;
};

/// Makes every later file and folder of this process unwritable for its group and for other users: adds 022 to the
/// umask. Child processes and libraries inherit it. Call it before any thread starts.
void keepOthersFromWriting();

/// Returns why a new file must not take the place of what `path` names: a symbolic link, or anything but a regular
/// file. Returns an empty text for a regular file, and if nothing has this name.
[[nodiscard]] std::string whyNotReplaceable(const std::filesystem::path& path);
/// Makes a file for writing at `path`, with access `mode` minus the umask. Never lets its group or other users write.
/// Removes any other file of this name, which can be left by a process that was killed. For a name that a user chose or
/// may have used, call whyNotReplaceable() before. Never follows a symbolic link and never waits. Returns the
/// descriptor, or -1 with errno.
[[nodiscard]] int makeFile(const std::filesystem::path& path, mode_t mode = 0644);
/// Writes all bytes to an open file, pipe or device, however few of them one system call takes. Returns false with
/// errno if the system refuses; part of the bytes is written then.
[[nodiscard]] bool writeAll(int descriptor, std::span<const std::uint8_t> bytes);
/// Removes a regular file or a symbolic link. Leaves everything else, such as a pipe, and reports no error.
void forgetFile(const std::filesystem::path& path);
/// Appends whole lines to a file, which it makes if it does not exist. If a crash has cut off the file's last line,
/// they begin on a line of their own. They are on disk when the function returns, and so is the name of a new file.
/// Refuses everything but a regular file, without waiting; also a symbolic link to one. Returns false with errno if it
/// fails.
[[nodiscard]] bool appendLines(const std::filesystem::path& path, std::string_view lines);

/// Returns why a session must not use the folder `path`: it belongs to another user, or other users may write to it.
/// The path may also be a link of another user. Such a user could replace files while a session runs. Returns an empty
/// text if the folder is safe or does not exist. A slash at the end of the path makes no difference.
[[nodiscard]] std::string whyUnsafeFolder(const std::filesystem::path& path);

/// Returns why a session must not use what earlier sessions left in its folder `out`, and what to do, as one line. That
/// is the journal, the folders `log`, `checkpoints` and `saves` with everything in them, and the files that a resumed
/// session continues, such as recoveries.jsonl. Each must belong to this user and be writable for this user alone. None
/// may be a symbolic link; one in place of a continued file is never followed, and may stay. Returns an empty text if
/// nothing is wrong.
[[nodiscard]] std::string whyUnsafeContent(const std::filesystem::path& out);

/// Makes a folder and its missing parents, to which only this user may write. The new names survive a power loss.
/// Throws std::filesystem::filesystem_error, also if the disk fails.
void makeFolders(const std::filesystem::path& path);

}  // namespace host
