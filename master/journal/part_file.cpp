// SPDX-License-Identifier: Apache-2.0
#include "master/journal/part_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

#include "base/input_error.hpp"
#include "host/regular_file.hpp"
#include "host/whole_file.hpp"

namespace master {
namespace {

constexpr std::int64_t kReservedPiece = 1 << 20;  // [byte]

/// Locks the file until it is closed. Returns false if another process holds the lock, and true on file systems
/// without locks.
bool lock(int descriptor) { return flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK; }

void lockOrThrow(int descriptor, const std::filesystem::path& path, const Pause& pause) {
    for (std::chrono::milliseconds left = PartFile::kPatience; !lock(descriptor); left -= PartFile::kPause) {
        if (left <= std::chrono::milliseconds(0)) {
            throw std::runtime_error(
                fmt::format("{}: another session writes it; stop that session first", path.string()));
        }
        pause(PartFile::kPause);
    }
}

/// Returns whether `path` still names the open file, and the file's length is still `seen`, so that no process has
/// written to it.
bool isAsSeen(int descriptor, const std::filesystem::path& path, std::int64_t seen) {
    struct stat mine {};
    struct stat named {};
    return fstat(descriptor, &mine) == 0 && lstat(path.c_str(), &named) == 0 && mine.st_dev == named.st_dev &&
           mine.st_ino == named.st_ino && mine.st_size == seen;
}

}  // namespace

void sleepFor(std::chrono::milliseconds length) { std::this_thread::sleep_for(length); }

PartFile::PartFile(std::filesystem::path path, int descriptor, std::int64_t size)
    : path_(std::move(path)), descriptor_(descriptor), size_(size), reserved_(size) {}

PartFile PartFile::make(const std::filesystem::path& path, std::span<const std::uint8_t> begin) {
    // The file has another name until its beginning is whole. So after a crash a file with the journal's name is always
    // a journal.
    if (const std::string special = host::whyNotReplaceable(path); !special.empty()) {
        throw base::InputError(fmt::format("{}: {}; choose another --out", path.string(), special));
    }
    const std::string beside = path.string() + ".part";
    const auto refuse = [&path] {
        throw base::InputError(
            fmt::format("{}: cannot be made ({}); choose another --out", path.string(), std::strerror(errno)));
    };
    PartFile file(path, host::makeFile(beside), 0);
    if (file.descriptor_ < 0) {
        refuse();
    }
    (void)lock(file.descriptor_);  // always succeeds, because the file is new
    try {
        file.write(begin);
        if (rename(beside.c_str(), path.c_str()) != 0 || !host::syncFolderOf(path)) {
            refuse();
        }
    } catch (const base::InputError&) {
        unlink(beside.c_str());
        throw;
    }
    return file;
}

PartFile PartFile::open(const std::filesystem::path& path, std::int64_t size, std::int64_t seen, const Pause& pause) {
    constexpr int kFlags = O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;  // does not wait for a pipe
    PartFile file(path, ::open(path.c_str(), O_WRONLY | kFlags), size);
    if (file.descriptor_ >= 0) {
        lockOrThrow(file.descriptor_, path, pause);
        // Otherwise records that another session has written since then would be cut off silently.
        if (!isAsSeen(file.descriptor_, path, seen)) {
            throw std::runtime_error(fmt::format("{}: has been written since it was read; start again", path.string()));
        }
    }
    if (file.descriptor_ < 0 || ftruncate(file.descriptor_, size) != 0 ||
        lseek(file.descriptor_, size, SEEK_SET) != size || fdatasync(file.descriptor_) != 0) {
        throw std::runtime_error(
            fmt::format("{}: the journal cannot be continued ({})", path.string(), std::strerror(errno)));
    }
    return file;
}

void PartFile::requireNoWriter(const std::filesystem::path& path, const Pause& pause) {
    const PartFile file(path, ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK), 0);
    if (file.descriptor_ >= 0) {
        lockOrThrow(file.descriptor_, path, pause);
    }
}

PartFile::PartFile(PartFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_),
      reserved_(other.reserved_) {}

PartFile& PartFile::operator=(PartFile&& other) noexcept {
    close();
    path_ = std::move(other.path_);
    descriptor_ = std::exchange(other.descriptor_, -1);
    size_ = other.size_;
    reserved_ = other.reserved_;
    return *this;
}

PartFile::~PartFile() { close(); }

void PartFile::close() {
    if (descriptor_ < 0) {
        return;
    }
    if (reserved_ > size_) {
        [[maybe_unused]] const int given = ftruncate(descriptor_, size_);  // gives back what was reserved
    }
    ::close(std::exchange(descriptor_, -1));
}

void PartFile::fail(const char* what) const {
    throw base::InputError(fmt::format("{}: {} ({})", path_.string(), what, std::strerror(errno)));
}

void PartFile::write(std::span<const std::uint8_t> bytes) {
    const auto failWhole = [this] {
        const int why = errno;
        // Cuts off the incomplete record, so that the file ends with the last whole one.
        [[maybe_unused]] const int cut = ftruncate(descriptor_, size_);
        [[maybe_unused]] const off_t back = lseek(descriptor_, size_, SEEK_SET);
        reserved_ = size_;
        errno = why;
        fail("the journal cannot be written");
    };
    const bool whole = host::writeAll(descriptor_, bytes);
    if (!whole || (fdatasync(descriptor_) != 0 && errno != EINVAL)) {  // pipes and the like cannot sync
        failWhole();
    }
    size_ += static_cast<std::int64_t>(bytes.size());
}

int PartFile::reserve(std::int64_t bytes) {
    if (reserved_ - size_ >= bytes) {
        return 0;
    }
    // The file's size stays the same, so that a reader sees no hole. Reserves a large piece at a time, because each is
    // a system call.
    for (const std::int64_t piece : {std::max(bytes, kReservedPiece), bytes}) {
        if (fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, size_, piece) == 0) {
            reserved_ = size_ + piece;
            return 0;
        }
    }
    return errno;
}

}  // namespace master
