// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

namespace master {

/// Waits for the given time. A test passes a function that counts instead.
using Pause = std::function<void(std::chrono::milliseconds)>;
/// Sleeps for `length`.
void sleepFor(std::chrono::milliseconds length);

/// A file that grows by whole records. What throws, throws base::InputError, and leaves the file ending with the
/// record before. One thread.
class PartFile {
public:
    /// A file that begins with these bytes, on disk: it has its name when they are. Replaces what is there.
    static PartFile make(const std::filesystem::path& path, std::span<const std::uint8_t> begin);
    /// Goes on at `size`; what stands behind is cut off. `seen` is how long the file was when it was read. Waits
    /// kPatience for another process that writes the file. Throws std::runtime_error, for it may be otherwise in a
    /// moment: when that one goes on, when the file is not what was read any more, and when the disk refuses.
    static PartFile open(const std::filesystem::path& path, std::int64_t size, std::int64_t seen,
                         const Pause& pause = sleepFor);
    /// Waits kPatience for another process that writes the file. Throws std::runtime_error if that process continues.
    static void requireNoWriter(const std::filesystem::path& path, const Pause& pause = sleepFor);
    /// A master that was killed has ended within kPatience. kPause is the time between two looks at the lock.
    static constexpr std::chrono::milliseconds kPatience{5000}, kPause{100};
    PartFile(PartFile&& other) noexcept;
    PartFile& operator=(PartFile&& other) noexcept;
    PartFile(const PartFile&) = delete;
    PartFile& operator=(const PartFile&) = delete;
    ~PartFile();

    /// On disk when it returns.
    void write(std::span<const std::uint8_t> bytes);
    /// Whether the disk has room for so many bytes more, and keeps it: 0, or why not, as errno has it. EOPNOTSUPP where
    /// the file system cannot.
    [[nodiscard]] int reserve(std::int64_t bytes);

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] std::int64_t size() const { return size_; }  // [byte]

private:
    PartFile(std::filesystem::path path, int descriptor, std::int64_t size);
    [[noreturn]] void fail(const char* what) const;
    void close();

    std::filesystem::path path_;
    int descriptor_;
    std::int64_t size_;      // [byte], of what is on disk, whole
    std::int64_t reserved_;  // [byte], that the disk has room for
};

}  // namespace master
