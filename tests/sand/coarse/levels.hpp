// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sand/grid/coarse_level.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"
#include "tests/support/sand/relaxing.hpp"

/// Sand that slides over coarse cells before it slides over the field's own.
namespace coarse {

using Levels = std::vector<std::pair<int, int>>;  // side [cell] and sweeps

/// Returns the levels of a sphere of 61 cells, of a rectangle as long, and of a sphere of 150 cells.
inline std::array<Levels, 3> levelsOfTools() { return {Levels{{4, 39}}, {{4, 39}, {2, 16}}, {{8, 59}, {4, 16}}}; }

inline std::string nameOf(const Levels& levels) {
    std::string name;
    for (const auto& [side, sweeps] : levels) {
        name += std::to_string(side) + ":" + std::to_string(sweeps) + " ";
    }
    return name;
}

/// Lets sand slide over the coarse levels and then over the field until it rests. Returns the outflow [unit · cell].
inline std::int64_t relaxCoarsely(sand::HeightField& field, const sand::Rules& rules, const Levels& levels) {
    std::int64_t outflow = 0;
    for (const auto& [side, sweeps] : levels) {
        outflow +=
            sand::grid::CoarseLevel({field, rules, nullptr, nullptr, {}}, field.bounds(), side).sweep(sweeps).outflow;
    }
    samples::relax(field, rules);
    return outflow;
}

}  // namespace coarse
