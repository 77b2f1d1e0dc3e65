// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>

namespace haptic_bridge {

/// Ends this process when its parent ends, so that nothing outlives a job. A thread of its own looks at the parent
/// until the process has ended.
///
/// The process first gets SIGTERM, and ends in order. If it has not ended after `patience`, any of its threads may
/// hang: aboutToBeKilled() becomes true, and SIGKILL follows a moment later. A stopped process is continued. Until
/// startIsOver() is called, the patience is at most a second, because a process that starts has nothing to keep.
///
/// @param parent  Value of getppid() at the start of main(). When getppid() returns another, the parent has ended.
///                A program that ends even earlier must kill its child itself, with PR_SET_PDEATHSIG before exec().
///
/// Call it once, on the main thread.
void endWithParent(pid_t parent, std::chrono::milliseconds patience = std::chrono::seconds(3));

/// Ends the shorter patience of a start. Any thread.
void startIsOver();

/// Becomes true a tenth of a second before endWithParent() kills this process. Any thread.
[[nodiscard]] const std::atomic<bool>& aboutToBeKilled();

}  // namespace haptic_bridge
