// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "walls/wall.hpp"

namespace walls {

/// The wall in another mode, on outputs that are open already: their number and sizes cannot change while a session
/// runs. Where a tile has an output for each eye, a mode that draws one eye shows it on both.
///
/// A function of the wall as the session began and of the mode, so that every rank finds the same. Throws
/// base::InputError in one line for a mode that these outputs cannot show.
[[nodiscard]] Wall shownOnItsOutputs(const Wall& wall, Stereo stereo);

}  // namespace walls
