// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/input_error.hpp"

namespace base {

/// Exit status for something that is missing now and may still come, such as a display while its machine starts. It is
/// EX_TEMPFAIL of sysexits.h.
inline constexpr int kExitNotYet = 75;

/// Error in something that may still come, so that a later try may succeed. The exit status is kExitNotYet.
class NotYetError : public InputError {
public:
    using InputError::InputError;
};

}  // namespace base
