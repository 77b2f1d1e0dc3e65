// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

namespace master {

/// Function that waits for the given time. A test passes one that counts instead.
using Pause = std::function<void(std::chrono::milliseconds)>;
/// Sleeps for `length`.
void sleepFor(std::chrono::milliseconds length);

/// A file that grows by whole records. If a function fails, it throws base::InputError unless it says otherwise, and
/// the file ends with the record before. Used by one thread.
class PartFile {
public:
    /// Makes a file that begins with the bytes `begin`. The file gets its name when these bytes are on disk. Replaces
    /// an existing file.
    static PartFile make(const std::filesystem::path& path, std::span<const std::uint8_t> begin);
    /// Opens a file in order to continue it at `size`, and cuts off the bytes behind it. `seen` is the file's length
    /// when it was read [byte]. Waits kPatience for another process that writes the file.
    ///
    /// Throws std::runtime_error if the other process continues, if the file has changed since it was read, or if the
    /// disk refuses. It does not throw base::InputError, because a later try may succeed.
    static PartFile open(const std::filesystem::path& path, std::int64_t size, std::int64_t seen,
                         const Pause& pause = sleepFor);
    /// Waits kPatience for another process that writes the file. Throws std::runtime_error if the other process
    /// continues.
    static void requireNoWriter(const std::filesystem::path& path, const Pause& pause = sleepFor);
    /// A master that was killed has ended within kPatience. kPause is the time between two tries to lock the file.
    static constexpr std::chrono::milliseconds kPatience{5000}, kPause{100};
    PartFile(PartFile&& other) noexcept;
    PartFile& operator=(PartFile&& other) noexcept;
    PartFile(const PartFile&) = delete;
    PartFile& operator=(const PartFile&) = delete;
    ~PartFile();

    /// Appends `bytes`, which are on disk when the function returns.
    void write(std::span<const std::uint8_t> bytes);
    /// Reserves room on the disk for `bytes` more bytes. Returns 0, or the errno of the failure; EOPNOTSUPP if the file
    /// system cannot reserve room.
    [[nodiscard]] int reserve(std::int64_t bytes);

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] std::int64_t size() const { return size_; }  // [byte]

private:
    PartFile(std::filesystem::path path, int descriptor, std::int64_t size);
    [[noreturn]] void fail(const char* what) const;
    void close();

    std::filesystem::path path_;
    int descriptor_;
    std::int64_t size_;      // [byte], length of the whole records on disk
    std::int64_t reserved_;  // [byte], length for which the disk has room
};

}  // namespace master
