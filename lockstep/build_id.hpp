// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lockstep {

/// Sixteen hex digits over the sources and the compiler this program was built from: ranks that differ are refused.
[[nodiscard]] const char* buildId();

}  // namespace lockstep
