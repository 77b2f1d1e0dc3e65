// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/byte_stream.hpp"

namespace scene {

/// Units of the lengths and heights of a raster. Programs hold heights in the unit of lengths, whatever unit the file
/// has.
struct RasterUnits {
    std::string crs{};            // coordinate reference system as WKT; empty if there is none
    double lengthMetres = 0;      // size of a length unit [m]; 0 if unknown
    double heightMetres = 0;      // size of the file's height unit [m]; 0 if unknown
    double heightsPerLength = 1;  // [file's height unit per length unit]
    std::string heightName{};     // the file's height unit as the file names it
    friend bool operator==(const RasterUnits&, const RasterUnits&) = default;
};

/// Origin of a scene's terrain, with all numbers that put results back there. No rule depends on it.
struct Georeference {
    RasterUnits units{};
    double west = 0, south = 0;  // south-west corner of the field [raster's length unit]
    double lengthPerUnit = 1;    // [raster's length unit per scene unit]
    double heightPerUnit = 1;  // [raster's length unit per scene unit] for heights; smaller if heights are exaggerated
    double datum = 0;          // the height that is 0 in the scene [scene unit]
    friend bool operator==(const Georeference&, const Georeference&) = default;

    /// Returns the size of a cubic scene unit [m³], or 0 if the length of the units is unknown.
    [[nodiscard]] double cubicMetres() const;

    void encode(base::ByteWriter& writer) const;
    /// Reads what encode() wrote. Throws base::FormatError for invalid numbers, and for a text that is too long to be a
    /// WKT.
    static Georeference decode(base::ByteReader& reader);
};

}  // namespace scene
