// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace host {

/// Keeps the memory of this process out of core dumps, until it ends. Call it before a secret is read. Any thread.
///
/// The kernel then writes no core file, and starts no program that collects cores.
void forbidCoreDumps();

}  // namespace host
