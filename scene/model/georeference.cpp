// SPDX-License-Identifier: Apache-2.0
#include "scene/model/georeference.hpp"

namespace scene {

double Georeference::cubicMetres() const {
    const double length = lengthPerUnit * units.lengthMetres;
    return length * length * heightPerUnit * units.heightsPerLength * units.heightMetres;
}

}  // namespace scene
