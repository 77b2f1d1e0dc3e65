// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace base {

/// Function that calls task(0) … task(count - 1) once each, in any order and on any threads. It returns when all tasks
/// have returned. Programs with spare cores pass one to the sand; the sand is the same with every executor.
using Executor = std::function<void(int count, const std::function<void(int)>& task)>;

}  // namespace base
