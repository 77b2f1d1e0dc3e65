// SPDX-License-Identifier: Apache-2.0
#include "scene/georeference.hpp"

#include <cmath>

namespace scene {
namespace {

constexpr std::size_t kLongestText = 1 << 16;  // [byte]; the WKT of a compound system takes a tenth of it

std::string shortText(base::ByteReader& reader) {
    std::string text = reader.getText();
    if (text.size() > kLongestText) {
        throw base::FormatError("a georeference with a text too long");
    }
    return text;
}

}  // namespace

double Georeference::cubicMetres() const {
    const double length = lengthPerUnit * units.lengthMetres;
    return length * length * heightPerUnit * units.heightsPerLength * units.heightMetres;
}

void Georeference::encode(base::ByteWriter& writer) const {
    writer.putText(units.crs);
    writer.putText(units.heightName);
    for (const double number : {units.lengthMetres, units.heightMetres, units.heightsPerLength, lengthPerUnit,
                                heightPerUnit, west, south, datum}) {
        writer.put(number);
    }
}

Georeference Georeference::decode(base::ByteReader& reader) {
    Georeference result;
    RasterUnits& units = result.units;
    units.crs = shortText(reader);
    units.heightName = shortText(reader);
    for (double* number : {&units.lengthMetres, &units.heightMetres, &units.heightsPerLength, &result.lengthPerUnit,
                           &result.heightPerUnit, &result.west, &result.south, &result.datum}) {
        *number = reader.get<double>();
        if (!std::isfinite(*number)) {
            throw base::FormatError("a georeference with a number that is not finite");
        }
    }
    if (units.lengthMetres < 0 || units.heightMetres < 0 || !(units.heightsPerLength > 0) ||
        !(result.lengthPerUnit > 0) || !(result.heightPerUnit > 0)) {
        throw base::FormatError("a georeference with a unit that is not positive");
    }
    return result;
}

}  // namespace scene
