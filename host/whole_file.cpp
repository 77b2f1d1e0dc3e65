// SPDX-License-Identifier: Apache-2.0
#include "host/whole_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <string_view>
#include <utility>
#include <vector>

#include "base/input_error.hpp"
#include "host/regular_file.hpp"

namespace host {
namespace {

constexpr mode_t kOthersWrite = S_IWGRP | S_IWOTH;
constexpr mode_t kAccess = S_IRWXU | S_IRWXG | S_IRWXO;

/// Returns the number of an open file of this process that `path` names, such as 1 for /dev/stdout, or -1. These names
/// are links to files that the process has opened already.
int ownDescriptor(const std::filesystem::path& path) {
    const std::string& name = path.native();
    constexpr std::string_view kFolder = "/dev/fd/";
    if (name == "/dev/stdout" || name == "/dev/stderr") {
        return name == "/dev/stdout" ? STDOUT_FILENO : STDERR_FILENO;
    }
    int number = -1;
    if (name.starts_with(kFolder)) {
        (void)std::from_chars(name.data() + kFolder.size(), name.data() + name.size(), number);
    }
    return number;
}

}  // namespace

WholeFile::WholeFile(const std::filesystem::path& path, Other other) : path_(path) {
    const std::string special = whyNotReplaceable(path);
    struct stat about {};
    const bool there = lstat(path.c_str(), &about) == 0;
    const int own = ownDescriptor(path);
    if (own < 0 && there && S_ISLNK(about.st_mode)) {
        throw base::InputError(fmt::format("{}: {}; remove it, or name the file itself", path_.string(), special));
    }
    // Renaming would replace a file that must not be written to.
    if (own < 0 && there && (S_ISDIR(about.st_mode) || ::access(path.c_str(), W_OK) != 0)) {
        fail();
    }
    if (!special.empty() && other == Other::refused) {
        throw base::InputError(fmt::format("{}: {}; remove it", path_.string(), special));
    }
    if (own >= 0) {
        descriptor_ = ::fcntl(own, F_DUPFD_CLOEXEC, 0);
    } else if (special.empty()) {
        const std::filesystem::path beside = path.string() + fmt::format(".{}.part", ::getpid());
        descriptor_ = makeFile(beside);
        if (descriptor_ >= 0) {
            beside_ = beside;
        }
    } else {
        descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NOFOLLOW);  // a pipe waits for a reader
    }
    if (descriptor_ >= 0) {
        // By its descriptor, because another file could have the name by now.
        stream_.open(fmt::format("/proc/self/fd/{}", descriptor_), std::ios::binary);
    }
    if (descriptor_ < 0 || !stream_) {
        fail();
    }
}

WholeFile::~WholeFile() { removePart(); }

void WholeFile::readBack(const std::function<void(std::span<const std::uint8_t>)>& take) {
    constexpr std::size_t kPiece = std::size_t{1} << 20;  // [byte]
    stream_.flush();
    std::ifstream written(fmt::format("/proc/self/fd/{}", descriptor_), std::ios::binary);
    if (!stream_.good() || !written) {
        fail();
    }
    for (std::vector<std::uint8_t> piece(kPiece); written;) {
        written.read(reinterpret_cast<char*>(piece.data()), static_cast<std::streamsize>(piece.size()));
        take(std::span(piece).first(static_cast<std::size_t>(written.gcount())));
    }
    if (!written.eof()) {
        fail();
    }
}

void WholeFile::keepSynced() {
    stream_.flush();
    if (!stream_.good() || (!beside_.empty() && ::fsync(descriptor_) != 0)) {
        fail();
    }
    keep();
    if (!syncFolderOf(path_)) {
        fail();
    }
}

void WholeFile::keep() {
    stream_.close();
    if (!stream_) {
        fail();
    }
    if (!beside_.empty()) {
        // Gives the file the access that the previous one has, except that others may not write to it.
        if (struct stat previous{}; lstat(path_.c_str(), &previous) == 0 && S_ISREG(previous.st_mode)) {
            (void)::fchmod(descriptor_, previous.st_mode & kAccess & ~kOthersWrite);
        }
        // Replaces a regular file and nothing else, also if another program has made something there meanwhile.
        if (!whyNotReplaceable(path_).empty() || ::rename(beside_.c_str(), path_.c_str()) != 0) {
            fail();
        }
        beside_.clear();
    }
}

void requireWritable(const std::filesystem::path& path) {
    struct stat about {};
    const bool pipe = lstat(path.c_str(), &about) == 0 && S_ISFIFO(about.st_mode);
    if (!pipe || ::access(path.c_str(), W_OK) != 0) {
        const WholeFile canBeWritten(path);
    }
}

bool syncFolderOf(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.parent_path().empty() ? "." : file.parent_path();
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) {
        return errno == EACCES;  // a folder may be used without the right to read it
    }
    const bool synced = ::fsync(descriptor) == 0 || errno == EINVAL;  // EINVAL: this file system cannot sync a folder
    const int error = errno;
    ::close(descriptor);
    errno = error;
    return synced;
}

void WholeFile::fail() {
    removePart();
    throw base::InputError(fmt::format("{}: cannot be written; check path and free space", path_.string()));
}

void WholeFile::removePart() {
    if (!beside_.empty()) {
        ::unlink(beside_.c_str());
        beside_.clear();
    }
    if (descriptor_ >= 0) {
        ::close(std::exchange(descriptor_, -1));
    }
}

}  // namespace host
