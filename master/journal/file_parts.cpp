// SPDX-License-Identifier: Apache-2.0
#include "master/journal/file_parts.hpp"

#include <fmt/format.h>

#include "base/input_error.hpp"

namespace master {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t kAhead = 1 << 16;  // [byte]

}  // namespace

fs::path partOf(const fs::path& journal, std::uint32_t part) {
    return part == 1 ? journal : fs::path(fmt::format("{}.{}", journal.string(), part));
}

bool FileParts::has(std::uint32_t part) const {
    std::error_code none;
    return fs::exists(fs::symlink_status(partOf(journal_, part), none));
}

void FileParts::open(std::uint32_t part) {
    const fs::path path = partOf(journal_, part);
    opened_ = 0;
    ahead_.clear();
    file_ = std::make_unique<host::RegularFile>(path, host::RegularFile::Links::refused);
    if (const std::string& why = file_->error(); !why.empty()) {
        const bool other = why.starts_with("is ");  // a link, a pipe, a folder
        throw base::InputError(other ? fmt::format("{}: {}; name the journal itself", path.string(), why)
                                     : fmt::format("{}: cannot be read ({}); check the path", path.string(), why));
    }
    opened_ = part;
}

std::int64_t FileParts::length(std::uint32_t part) {
    open(part);
    return static_cast<std::int64_t>(file_->size());
}

void FileParts::read(std::uint32_t part, std::int64_t offset, std::int64_t size, base::Bytes& bytes) {
    if (part != opened_) {
        open(part);
    }
    const auto within = [&] {
        return offset >= aheadAt_ && offset + size <= aheadAt_ + static_cast<std::int64_t>(ahead_.size());
    };
    bool good = true;
    if (size <= kAhead && !within()) {
        aheadAt_ = offset;
        good = file_->readAt(static_cast<std::uint64_t>(offset), kAhead, ahead_);
    }
    if (size <= kAhead) {
        const auto from = ahead_.begin() + std::min<std::ptrdiff_t>(offset - aheadAt_, std::ssize(ahead_));
        bytes.assign(from, from + std::min<std::ptrdiff_t>(size, ahead_.end() - from));
    } else {
        good = file_->readAt(static_cast<std::uint64_t>(offset), static_cast<std::size_t>(size), bytes);
    }
    if (!good) {
        throw base::InputError(fmt::format("{}: cannot be read; the disk fails", name(part)));
    }
}

}  // namespace master
