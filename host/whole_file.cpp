// SPDX-License-Identifier: Apache-2.0
#include "host/whole_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>

#include "base/input_error.hpp"
#include "host/regular_file.hpp"

namespace host {

WholeFile::WholeFile(const std::filesystem::path& path, Other other) : path_(path), target_(path) {
    std::error_code none;
    const bool there = std::filesystem::exists(path, none);
    // Renaming would replace a file that must not be written to.
    if (there && (std::filesystem::is_directory(path, none) || ::access(path.c_str(), W_OK) != 0)) {
        fail();
    }
    if (there && !std::filesystem::is_regular_file(path, none)) {
        if (other == Other::refused) {
            throw base::InputError(fmt::format("{}: is not a regular file; remove it", path_.string()));
        }
        stream_.open(target_, std::ios::binary);
    } else {
        if (there) {
            target_ = std::filesystem::canonical(path, none);  // keeps a link a link
        }
        beside_ = target_.string() + fmt::format(".{}.part", ::getpid());
        // A pipe or link of this name is removed, because opening a pipe would wait for a reader.
        if (const int made = makeFile(beside_, 0666); made >= 0) {
            ::close(made);
            stream_.open(beside_, std::ios::binary | std::ios::trunc);
        } else {
            stream_.setstate(std::ios::failbit);
        }
    }
    if (!stream_) {
        fail();
    }
}

WholeFile::~WholeFile() { removePart(); }

void WholeFile::keepSynced() {
    stream_.flush();
    bool synced = stream_.good();
    if (!beside_.empty()) {
        const int descriptor = ::open(beside_.c_str(), O_WRONLY | O_CLOEXEC);
        synced = synced && descriptor >= 0 && ::fsync(descriptor) == 0;
        if (descriptor >= 0) {
            ::close(descriptor);
        }
    }
    if (!synced) {
        fail();
    }
    keep();
    if (!syncFolderOf(target_)) {
        fail();
    }
}

void WholeFile::keep() {
    stream_.close();
    if (!stream_) {
        fail();
    }
    if (!beside_.empty()) {
        std::error_code error;
        if (const auto status = std::filesystem::status(target_, error); std::filesystem::exists(status)) {
            std::filesystem::permissions(beside_, status.permissions(), error);
        }
        std::filesystem::rename(beside_, target_, error);
        if (error) {
            fail();
        }
        beside_.clear();
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
        std::error_code none;
        std::filesystem::remove(beside_, none);
        beside_.clear();
    }
}

}  // namespace host
