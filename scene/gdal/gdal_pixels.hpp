// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include "scene/gdal/gdal_raster.hpp"

namespace scene {

/// Returns the numbers of the raster's band as its file holds them, in the order of the file's rows. A pixel without
/// data is NaN. GDAL reads a stripe of rows at a time, and keeps no block that later rows do not need. Calls
/// check.read(). Throws base::InputError for pixels that cannot be read, and for a number whose height is infinite.
[[nodiscard]] RasterHeights numbersOf(const GdalRaster& raster, const RasterCheck& check);

}  // namespace scene
