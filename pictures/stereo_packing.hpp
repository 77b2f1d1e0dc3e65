// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pictures/image.hpp"
#include "walls/wall.hpp"

namespace pictures {

/// Returns the picture of an output that carries both eyes. It is the reference that a render rank's graphics card must
/// equal. Its size is walls::outputPixels(stereo, size of an eye's picture).
///
/// Rows and columns count from 0 at the top left of the output. Side-by-side and top-bottom pictures keep all pixels of
/// both eyes. Interlaced and checkerboard pictures take each pixel from the same place of one eye or the other.
/// Anaglyphs mix the eyes (anaglyph.hpp): anaglyphColour copies sRGB levels, the other two modes work in linear light.
///
/// Throws std::invalid_argument if the sizes differ or if the mode does not show two eyes in one picture (mono, left,
/// right, passive, active).
[[nodiscard]] Image packStereo(walls::Stereo stereo, const Image& left, const Image& right);

}  // namespace pictures
