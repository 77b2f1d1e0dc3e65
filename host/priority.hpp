// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace host {

/// Lowers the priority of the calling thread, so that the other threads of the machine get most of the processor. The
/// thread keeps this priority until it ends.
void lowerPriority();

}  // namespace host
