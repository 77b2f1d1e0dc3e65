// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace fuzz {

/// Names under which an input is written: the raster, and a file that GDAL reads beside it. GDAL recognises some
/// formats by the name alone.
struct RasterNames {
    const char* raster;
    const char* beside;
};

/// The first byte of an input of the fuzzer of rasters chooses one of these.
inline constexpr std::array kRasterNames{
    RasterNames{"r.tif", "r.tif.aux.xml"}, RasterNames{"r.tif", "r.tif.ovr"},  RasterNames{"r.tif", "r.tif.msk"},
    RasterNames{"r.tif", "r.tfw"},         RasterNames{"r.asc", "r.prj"},      RasterNames{"r.png", "r.pgw"},
    RasterNames{"r.bil", "r.hdr"},         RasterNames{"r.dat", "r.hdr"},      RasterNames{"r.sdat", "r.sgrd"},
    RasterNames{"r.rst", "r.rdc"},         RasterNames{"r", "r.ers"},          RasterNames{"r.dem", "r.dem.rsc"},
    RasterNames{"r.mpr", "r.mp#"},         RasterNames{"N45E006.hgt", "none"}, RasterNames{"r.img", "r.ige"},
};

}  // namespace fuzz
