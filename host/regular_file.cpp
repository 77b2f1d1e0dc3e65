// SPDX-License-Identifier: Apache-2.0
#include "host/regular_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "host/whole_file.hpp"

namespace host {
namespace {

constexpr mode_t kOthersMayWrite = S_IWGRP | S_IWOTH;
// Without O_NONBLOCK, open() would wait until a process opens the other end of a pipe.
constexpr int kToRead = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;

/// Closes `descriptor` and returns false with this errno.
bool refused(int descriptor, int error) {
    close(descriptor);
    errno = error;
    return false;
}

/// Closes `descriptor` and returns `next`. The errno stays that of the call that has returned `next`.
int replaced(int descriptor, int next) {
    const int error = errno;
    close(descriptor);
    errno = error;
    return next;
}

/// Returns the descriptor of the folder `name` in the folder `held`, which it closes. Returns -1 with errno for all
/// else; ELOOP for a link.
int folderIn(int held, const char* name) {
    const int folder = openat(held, name, O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    struct stat about {};
    if (folder < 0 && fstatat(held, name, &about, AT_SYMLINK_NOFOLLOW) == 0) {
        errno = S_ISLNK(about.st_mode) ? ELOOP : ENOTDIR;
    }
    return replaced(held, folder);
}

bool isFileOrLink(const std::filesystem::path& path) {
    struct stat about {};
    return lstat(path.c_str(), &about) == 0 && (S_ISREG(about.st_mode) || S_ISLNK(about.st_mode));
}

/// Returns why a session must not use an entry of its folder, and what to do.
std::string whyUnsafeEntry(const std::filesystem::path& entry) {
    struct stat about {};
    if (lstat(entry.c_str(), &about) != 0) {
        return "";
    }
    // scripts/launcher/base/session_folder.py has the same messages.
    if (S_ISLNK(about.st_mode)) {
        return entry.string() +
               ": is a link, and a session follows none in its folder; remove it, or choose another --out";
    }
    if (about.st_uid != geteuid()) {
        return entry.string() + ": belongs to another user; remove it, or choose another --out";
    }
    return (about.st_mode & kOthersMayWrite) == 0
               ? ""
               : entry.string() +
                     ": other users may write to it; run chmod -R go-w on the session's folder, or "
                     "choose another --out";
}

}  // namespace

RegularFile::RegularFile(const std::filesystem::path& path, Links links) {
    const int follow = links == Links::followed ? 0 : O_NOFOLLOW;
    take(open(path.c_str(), kToRead | follow), links == Links::refused);
}

RegularFile::RegularFile(const std::filesystem::path& folder, const std::filesystem::path& inside) {
    int held = open(folder.empty() ? "." : folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    for (const std::filesystem::path& name : inside.parent_path()) {
        if (held >= 0) {
            held = folderIn(held, name.c_str());
        }
    }
    take(held < 0 ? -1 : replaced(held, openat(held, inside.filename().c_str(), kToRead | O_NOFOLLOW)), true);
}

void RegularFile::take(int descriptor, bool linksRefused) {
    descriptor_ = descriptor;
    if (descriptor_ < 0 || fstat(descriptor_, &about_) != 0) {
        error_ = errno == ELOOP && linksRefused ? "is a link, which is not followed" : std::strerror(errno);
    } else if (!S_ISREG(about_.st_mode)) {
        error_ = "is not a regular file";
    }
}

RegularFile::~RegularFile() {
    if (descriptor_ >= 0) {
        close(descriptor_);
    }
}

std::uintmax_t RegularFile::size() const { return static_cast<std::uintmax_t>(about_.st_size); }

std::string RegularFile::whyNotPrivate() const {
    if (about_.st_uid != geteuid()) {
        return "belongs to another user";
    }
    return (about_.st_mode & (S_IRWXG | S_IRWXO)) != 0 ? "other users may read or change it" : "";
}

std::optional<std::vector<std::uint8_t>> RegularFile::read(std::size_t most) const {
    std::vector<std::uint8_t> bytes;
    return readAt(0, std::min<std::uintmax_t>(most, size()), bytes) ? std::optional(std::move(bytes)) : std::nullopt;
}

bool RegularFile::readAt(std::uint64_t offset, std::size_t size, std::vector<std::uint8_t>& bytes) const {
    bytes.resize(size);
    std::size_t done = 0;
    while (done < size) {
        const ssize_t count = pread(descriptor_, bytes.data() + done, size - done, static_cast<off_t>(offset + done));
        if (count < 0 && errno != EINTR) {
            return false;
        }
        if (count == 0) {
            break;  // the end, or the file has become shorter
        }
        done += count > 0 ? static_cast<std::size_t>(count) : 0;
    }
    bytes.resize(done);
    return true;
}

void keepOthersFromWriting() { umask(umask(kOthersMayWrite) | kOthersMayWrite); }

std::string whyNotReplaceable(const std::filesystem::path& path) {
    struct stat about {};
    if (lstat(path.c_str(), &about) != 0 || S_ISREG(about.st_mode)) {
        return "";
    }
    return S_ISLNK(about.st_mode) ? "is a link, which is not followed" : "is not a regular file";
}

int makeFile(const std::filesystem::path& path, mode_t mode) {
    constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
    const int made = open(path.c_str(), kFlags, mode & ~kOthersMayWrite);
    if (made >= 0 || errno != EEXIST || unlink(path.c_str()) != 0) {
        return made;
    }
    return open(path.c_str(), kFlags, mode & ~kOthersMayWrite);
}

bool writeAll(int descriptor, std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t count = write(descriptor, bytes.data(), bytes.size());
        if (count < 0 && errno != EINTR) {
            return false;
        }
        bytes = bytes.subspan(count > 0 ? static_cast<std::size_t>(count) : 0);
    }
    return true;
}

void forgetFile(const std::filesystem::path& path) {
    if (isFileOrLink(path)) {
        unlink(path.c_str());
    }
}

bool appendLines(const std::filesystem::path& path, std::string_view lines) {
    constexpr int kFlags = O_RDWR | O_APPEND | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
    int descriptor = open(path.c_str(), kFlags);
    const bool made = descriptor < 0 && errno == ENOENT;
    if (made) {
        descriptor = open(path.c_str(), kFlags | O_CREAT | O_EXCL, 0644);
    }
    struct stat about {};
    if (descriptor < 0 || fstat(descriptor, &about) != 0) {
        return descriptor >= 0 && refused(descriptor, errno);
    }
    if (!S_ISREG(about.st_mode)) {
        return refused(descriptor, EINVAL);
    }
    char last = '\n';
    if (about.st_size > 0 && pread(descriptor, &last, 1, about.st_size - 1) != 1) {
        return refused(descriptor, errno);
    }
    const std::string text = (last == '\n' ? "" : "\n") + std::string(lines);
    if (!writeAll(descriptor, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()})) {
        return refused(descriptor, errno);
    }
    if (fdatasync(descriptor) != 0 || (made && !syncFolderOf(path))) {
        return refused(descriptor, errno);
    }
    close(descriptor);
    return true;
}

std::string whyUnsafeFolder(const std::filesystem::path& path) {
    // With a slash behind its name, lstat() would follow a link.
    std::filesystem::path name = path;
    while ((!name.has_filename() || name.filename() == ".") && name.has_relative_path() && name.has_parent_path()) {
        name = name.parent_path();
    }
    struct stat link {};
    struct stat folder {};
    if (lstat(name.c_str(), &link) != 0 || stat(name.c_str(), &folder) != 0) {
        return "";
    }
    if (link.st_uid != geteuid()) {
        return S_ISLNK(link.st_mode) ? "is a link of another user" : "belongs to another user";
    }
    if (folder.st_uid != geteuid()) {
        return "leads to a folder of another user";
    }
    return (folder.st_mode & kOthersMayWrite) != 0 ? "other users may write to it" : "";
}

std::string whyUnsafeContent(const std::filesystem::path& out) {
    const std::array<std::string_view, 3> folders{"log", "checkpoints", "saves"};
    const std::array<std::string_view, 5> continued{"divergence.txt", "drills.done", "failures.jsonl", "incidents.json",
                                                    "recoveries.jsonl"};
    std::error_code none;  // ignored, because the folders need not exist
    for (const auto& entry : std::filesystem::directory_iterator(out, none)) {
        const std::string name = entry.path().filename().string();
        const bool folder = std::find(folders.begin(), folders.end(), name) != folders.end();
        // A link is never followed: a new session removes it, and a resumed one refuses to append to it.
        const bool file =
            std::find(continued.begin(), continued.end(), name) != continued.end() && !entry.is_symlink(none);
        if (!folder && !file && !name.starts_with("session.journal")) {
            continue;
        }
        if (std::string why = whyUnsafeEntry(entry.path()); !why.empty()) {
            return why;
        }
        for (const auto& inside : std::filesystem::directory_iterator(folder ? entry.path() : "", none)) {
            if (std::string why = whyUnsafeEntry(inside.path()); !why.empty()) {
                return why;
            }
        }
    }
    return "";
}

void makeFolders(const std::filesystem::path& path) {
    // The path is not simplified: behind a link, ".." is not the folder that holds the link.
    std::vector<std::filesystem::path> missing;
    for (std::filesystem::path folder = std::filesystem::absolute(path); !std::filesystem::exists(folder);
         folder = folder.parent_path()) {
        // A path that ends with a slash has an empty last part.
        if (folder.has_filename()) {
            missing.push_back(folder);
        }
    }
    std::for_each(missing.rbegin(), missing.rend(), [](const std::filesystem::path& folder) {
        constexpr mode_t kMode = 0755;  // with a umask such as 002, 0777 would let the user's group write to it
        if (mkdir(folder.c_str(), kMode) != 0 && (errno != EEXIST || !std::filesystem::is_directory(folder))) {
            throw std::filesystem::filesystem_error("cannot make a folder", folder,
                                                    std::error_code(errno, std::generic_category()));
        }
        if (!syncFolderOf(folder)) {
            throw std::filesystem::filesystem_error("cannot sync a folder", folder.parent_path(),
                                                    std::error_code(errno, std::generic_category()));
        }
    });
}

}  // namespace host
