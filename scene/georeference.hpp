// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/byte_stream.hpp"

namespace scene {

/// What the lengths and heights of a raster are. Programs hold heights in the unit of lengths, whatever the file's.
struct RasterUnits {
    std::string crs{};            // coordinate reference system as WKT; empty: none
    double lengthMetres = 0;      // [m] of one length unit; 0: nobody said
    double heightMetres = 0;      // [m] of one of the file's height units; 0: nobody said
    double heightsPerLength = 1;  // [file's height unit per length unit]
    std::string heightName{};     // the file's height unit as the file names it
    friend bool operator==(const RasterUnits&, const RasterUnits&) = default;
};

/// Where a scene's terrain came from: what it takes to put results back there. No rule depends on it.
struct Georeference {
    RasterUnits units{};
    double west = 0, south = 0;  // of the field's south-west corner [raster's length unit]
    double lengthPerUnit = 1;    // [raster's length unit per scene unit]
    double heightPerUnit = 1;    // [raster's length unit per scene unit], of heights: less where they are exaggerated
    double datum = 0;            // the height that is 0 in the scene [scene unit]
    friend bool operator==(const Georeference&, const Georeference&) = default;

    /// [m³] of a cubic scene unit; 0: nobody said how long the units are.
    [[nodiscard]] double cubicMetres() const;

    void encode(base::ByteWriter& writer) const;
    /// Throws base::FormatError for numbers that cannot be and texts that are no WKT's length.
    static Georeference decode(base::ByteReader& reader);
};

}  // namespace scene
