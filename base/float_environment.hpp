// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// How the processor computes with floats on the calling thread: rounding, subnormal numbers, traps.
///
/// The sand needs what the C standard calls the default: rounding to nearest, subnormal numbers as they are, no traps.
/// A library that was compiled with fast-math changes this for the thread that loads it, and for all threads that the
/// thread creates later. A replica would then compute other sand than the others.
namespace base {

/// Sets the calling thread to what the sand needs. Returns whether it was set otherwise. Takes a few nanoseconds.
bool needDefaultFloats();

/// Returns what the calling thread does otherwise than the sand needs, such as "rounds up, flushes subnormal results to
/// zero". Returns an empty text if it does nothing otherwise.
[[nodiscard]] std::string unusualFloats();

/// Does both: sets the calling thread to what the sand needs, and returns the text of unusualFloats() from before. Call
/// it after libraries were loaded.
[[nodiscard]] std::string repairFloats();

}  // namespace base
