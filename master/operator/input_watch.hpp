// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <thread>

namespace master {

/// Exit status of a master whose standard input ended before the first frame. scripts/launcher/job/processes.py has the
/// same number.
inline constexpr int kExitStopped = 76;

/// Thread that notices the end of an input before the first frame. The launcher holds the other end of the master's
/// standard input. When the launcher ends, a master that starts has nothing to keep, and must not read a large scene to
/// its end. Later OperatorInput notices the end of the input, and the session ends in order.
///
/// The thread reads nothing, so that OperatorInput gets all lines.
class InputWatch {
public:
    /// Calls `ended` once if the input `descriptor`, a pipe, has no writer any more. `ended` runs on the thread. Throws
    /// std::system_error if the system has no descriptor left.
    InputWatch(int descriptor, std::function<void()> ended);
    /// Ends the watch. `ended` is not called afterwards.
    ~InputWatch();
    InputWatch(const InputWatch&) = delete;
    InputWatch& operator=(const InputWatch&) = delete;

private:
    void watch(int descriptor) const;

    std::function<void()> ended_;
    int wake_;
    std::thread thread_;
};

/// Ends this process with kExitStopped, after a line. mpirun then ends the ranks.
[[noreturn]] void endForLackOfInput();

}  // namespace master
