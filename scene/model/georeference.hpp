// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

#include "base/field_forms.hpp"
#include "scene/model/longest_text.hpp"

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

    /// The order in an encoded scene.
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        constexpr double kHighest = std::numeric_limits<double>::max();
        constexpr double kLeast = std::numeric_limits<double>::denorm_min();  // the least that is more than 0
        visit("crs", base::text(it.units.crs, kLongestText));
        visit("height_unit", base::text(it.units.heightName, kLongestText));
        visit("length_metres", base::limited(it.units.lengthMetres, 0, kHighest));
        visit("height_metres", base::limited(it.units.heightMetres, 0, kHighest));
        visit("heights_per_length", base::limited(it.units.heightsPerLength, kLeast, kHighest));
        visit("length_per_unit", base::limited(it.lengthPerUnit, kLeast, kHighest));
        visit("height_per_unit", base::limited(it.heightPerUnit, kLeast, kHighest));
        visit("west", it.west);
        visit("south", it.south);
        visit("datum", it.datum);
    }
};

}  // namespace scene
