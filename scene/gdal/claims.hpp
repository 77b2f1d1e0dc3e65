// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "scene/gdal/gdal_raster.hpp"

namespace scene {

/// Compares what the header of a raster claims with what its files hold. GDAL 3.6.2 does not do so in these cases: it
/// reads heights of 0 behind the end of some files, and concludes a type of numbers from the size. It also reads "1,5"
/// as two numbers or as 1.
///
/// Throws base::InputError if a file is shorter or several times longer than its header says. Also throws if a number
/// in a text has a decimal comma. The line has the file, and in a text the line.
void checkClaims(const GdalRaster& raster);

/// Returns what a raster without a header inside lacks beside it, as the end of a message: "; it needs its header t.hdr
/// beside it". Returns an empty text if nothing is known to be missing.
[[nodiscard]] std::string missingHeader(const std::filesystem::path& file);

/// Returns the unit of lengths that the text header of an Idrisi or ENVI raster names, in small letters. GDAL 3.6.2
/// takes metres for a unit that it does not know, also for degrees. Returns nullopt for other formats and without a
/// unit. Throws base::InputError if an Idrisi header scales the unit.
[[nodiscard]] std::optional<std::string> lengthUnitInHeader(const GdalRaster& raster);

/// Returns the bytes that a NetCDF file of the classic format must have by its header [byte]. Returns nullopt for other
/// files, and for a header that is damaged. `begin` are the first bytes of the file.
[[nodiscard]] std::optional<std::uint64_t> classicNetcdfSize(std::string_view begin);

}  // namespace scene
