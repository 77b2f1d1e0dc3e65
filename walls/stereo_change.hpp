// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "walls/wall.hpp"

namespace walls {

/// Returns the wall in another stereo mode on its open outputs. The number and the sizes of outputs cannot change
/// during a session. If a tile has an output for each eye, a mode that draws one eye shows it on both outputs.
///
/// The result depends only on the wall at the start of the session and on the mode, so that all ranks agree. Throws
/// base::InputError, with one line, if these outputs cannot show the mode.
[[nodiscard]] Wall shownOnItsOutputs(const Wall& wall, Stereo stereo);

/// Returns the modes that shownOnItsOutputs() accepts, except the wall's own, as names in the order of Stereo.
[[nodiscard]] std::vector<std::string> otherModesOf(const Wall& wall);

}  // namespace walls
