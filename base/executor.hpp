// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace base {

/// Calls task(0) … task(count - 1) once each, in any order and on any threads, and returns when all have returned.
/// Handed in by programs that have cores to spare; the sand is the same with any of them, or none.
using Executor = std::function<void(int count, const std::function<void(int)>& task)>;

}  // namespace base
