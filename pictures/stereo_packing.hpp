// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pictures/image.hpp"
#include "walls/wall.hpp"

namespace pictures {

/// The one picture of an output that carries both eyes: the reference that a render rank's graphics card must equal.
///
/// Of walls::outputPixels(stereo, size of an eye's picture). Rows and columns count from 0 at the top left of the
/// output. Side by side and top-bottom keep all pixels of both eyes; interlaced and checkerboard pictures take each
/// pixel from the same place of the one eye or the other; anaglyphs mix the eyes (anaglyph.hpp): anaglyphColour copies
/// sRGB levels, the other two work in linear light.
/// Throws std::invalid_argument when the sizes differ or the mode shows no two eyes in one picture (mono, left, right,
/// passive, active).
[[nodiscard]] Image packStereo(walls::Stereo stereo, const Image& left, const Image& right);

}  // namespace pictures
