// SPDX-License-Identifier: Apache-2.0
#include "scene/import/raster_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/input_error.hpp"

namespace scene {
namespace {

constexpr double kSame = 1e-6;  // largest difference of two sizes of one unit, as a share; 2e-6 separates the two feet

bool sameSize(double a, double b) { return std::abs(a - b) <= kSame * std::abs(a); }

}  // namespace

std::string unitName(double metres) {
    constexpr std::array<std::pair<double, const char*>, 7> kNames{{{1, "metres"},
                                                                    {0.3048, "feet"},
                                                                    {1200.0 / 3937, "US survey feet"},
                                                                    {1000, "kilometres"},
                                                                    {0.01, "centimetres"},
                                                                    {0.001, "millimetres"},
                                                                    {0, "units of unknown length"}}};
    for (const auto& [size, name] : kNames) {
        if (sameSize(size, metres)) {
            return name;
        }
    }
    return fmt::format("units of {:.6g} m", metres);
}

RasterStatement statementOf(const EsriGrid& grid) {
    const RasterUnits& units = grid.units;
    RasterStatement result;
    result.file = grid.file;
    result.across = unitName(units.lengthMetres);
    result.acrossFrom = grid.origins.across.empty() ? "no coordinate system" : grid.origins.across;
    const bool sameUp = grid.origins.up.empty();
    result.up = sameUp ? "the same" : unitName(units.heightMetres);
    result.upFrom = sameUp ? "no unit of heights" : grid.origins.up;
    if (grid.noData) {
        result.noData = fmt::format("{}", *grid.noData);
    }
    const auto empty = std::count_if(grid.heights.begin(), grid.heights.end(), [](double h) { return std::isnan(h); });
    result.noDataShare =
        grid.heights.empty() ? 0 : static_cast<double>(empty) / static_cast<double>(grid.heights.size());
    return result;
}

RasterStatement statementOf(const Points& /*points*/, const std::string& file) {
    return {.file = file,
            .across = unitName(0),
            .acrossFrom = "points",
            .up = "the same",
            .upFrom = "points",
            .noData = {}};
}

void requireSameUnits(const RasterUnits& sand, const std::string& file, const EsriGrid& rock) {
    const auto fail = [&](const std::string& message) {
        throw base::InputError(fmt::format("{}: {}; {} is the sand's file", rock.file, message, file));
    };
    const RasterUnits& below = rock.units;
    if (sand.lengthMetres > 0 && below.lengthMetres > 0 && !sameSize(sand.lengthMetres, below.lengthMetres)) {
        fail(fmt::format("the rock has {} across, and the sand {}; give both the same coordinate system with gdalwarp",
                         unitName(below.lengthMetres), unitName(sand.lengthMetres)));
    }
    // Rock without units has those of the sand. If the sand has two, the rock's heights could be in either.
    const bool noUnits = below.lengthMetres == 0 && below.heightMetres == 0;
    if (noUnits && sand.heightsPerLength != 1) {
        fail(
            fmt::format("the rock declares no units, and the sand has {} across and {} up, so that the rock's heights "
                        "could be in either; put a .prj file beside the rock, as the sand has it",
                        unitName(sand.lengthMetres), unitName(sand.heightMetres)));
    }
    const bool sandHasNone = sand.lengthMetres == 0 && sand.heightMetres == 0;
    if (sandHasNone && below.heightsPerLength != 1) {
        fail(
            fmt::format("the sand declares no units, and the rock has {} across and {} up, so that the sand's heights "
                        "could be in either; put a .prj file beside the sand, as the rock has it",
                        unitName(below.lengthMetres), unitName(below.heightMetres)));
    }
}

void requireSameUnits(const EsriGrid& sand, const EsriGrid& rock) { requireSameUnits(sand.units, sand.file, rock); }

}  // namespace scene
