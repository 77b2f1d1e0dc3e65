// SPDX-License-Identifier: Apache-2.0
#include "master/journal/file_parts.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/input_error.hpp"

namespace master {

namespace fs = std::filesystem;

fs::path partOf(const fs::path& journal, std::uint32_t part) {
    return part == 1 ? journal : fs::path(fmt::format("{}.{}", journal.string(), part));
}

bool FileParts::has(std::uint32_t part) const {
    std::error_code none;
    return fs::exists(partOf(journal_, part), none);
}

void FileParts::open(std::uint32_t part) {
    const fs::path file = partOf(journal_, part);
    std::error_code none;
    stream_.close();
    opened_ = 0;
    // Opening a pipe would wait until a process writes to it.
    if (fs::is_fifo(file, none)) {
        throw base::InputError(fmt::format("{}: cannot be read; it is not a plain file", file.string()));
    }
    stream_.open(file, std::ios::binary);
    if (!stream_ || fs::is_directory(file, none)) {
        throw base::InputError(fmt::format("{}: cannot be read; check the path", file.string()));
    }
    opened_ = part;
    position_ = -1;
}

std::int64_t FileParts::length(std::uint32_t part) {
    open(part);
    stream_.seekg(0, std::ios::end);
    const std::int64_t size = stream_.tellg();
    if (size < 0) {
        throw base::InputError(
            fmt::format("{}: cannot be read; it is not a plain file", partOf(journal_, part).string()));
    }
    return size;
}

void FileParts::read(std::uint32_t part, std::int64_t offset, std::int64_t size, base::Bytes& bytes) {
    if (part != opened_) {
        open(part);
    }
    // A seek empties the stream's buffer, and records are read one after another.
    if (offset != position_) {
        stream_.seekg(offset);
    }
    bytes.resize(static_cast<std::size_t>(size));
    stream_.read(reinterpret_cast<char*>(bytes.data()), size);
    bytes.resize(static_cast<std::size_t>(stream_.gcount()));
    position_ = stream_ ? offset + size : -1;
    stream_.clear();
}

}  // namespace master
