// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace support {

/// Simulates the monotonic clock of this process. Its time passes only while a thread waits with a limit, as
/// std::condition_variable::wait_for() does. Such a wait takes no real time, and always ends at its limit.
///
/// One object at a time, and at most one thread that waits with a limit. A test uses it in a child process. The object
/// files of virtual_time.cpp replace functions of the C library, also without such an object.
class VirtualTime {
public:
    /// `now` holds the time [ns]. It must be above 0, and may be in memory that the parent process shares.
    explicit VirtualTime(std::atomic<std::int64_t>& now);
    ~VirtualTime() { end(); }
    VirtualTime(const VirtualTime&) = delete;
    VirtualTime& operator=(const VirtualTime&) = delete;

    /// Lets the other thread wait as often as it needs until `seconds` have passed. Returns when its next wait would
    /// last longer.
    void pass(double seconds);
    /// Advances the clock during a wait of the other thread, as if the process had been stopped.
    void jump(double seconds);
    /// Returns to the real clock. The present wait ends at once. Call this before the other thread is joined.
    void end();
};

}  // namespace support
