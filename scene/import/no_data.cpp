// SPDX-License-Identifier: Apache-2.0
#include "scene/import/no_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace scene {
namespace {

// Default of ESRI and GDAL, elevation tiles of 16 bits, and the number of some surveys.
constexpr std::array<double, 3> kUsual{-9999, -32768, -99999};

/// Returns whether a height is `number`. Dividing it by a unit and multiplying it again causes at most two roundings.
bool isNumber(double height, double number) { return std::abs(height - number) <= 1e-15 * std::abs(number); }

/// Size of the largest 32-bit float, as programs round it up or down that print few digits.
constexpr double kLargestFloat = 3.4028234663852886e38;
bool isLargest(double number) { return std::abs(std::abs(number) - kLargestFloat) <= 1e-5 * kLargestFloat; }

std::string warning(const std::string& file, std::ptrdiff_t count, const char* what, double number,
                    const std::string& how) {
    return fmt::format("{}: {} {}{} the height {}, which usually means no data and is taken for a height here; {}",
                       file, count, what, count == 1 ? " has" : "s have", number,
                       fmt::format(fmt::runtime(how), number));
}

}  // namespace

bool meansNoData(double height, double noData) {
    if (isLargest(height) && isLargest(noData)) {
        return (height < 0) == (noData < 0);
    }
    // A double beyond the range of float cannot be converted.
    const bool fits = std::abs(height) <= kLargestFloat && std::abs(noData) <= kLargestFloat;
    return height == noData || (fits && static_cast<float>(height) == static_cast<float>(noData));
}

bool isUsualNoData(double number) {
    return std::any_of(kUsual.begin(), kUsual.end(), [&](double usual) { return isNumber(number, usual); });
}

std::vector<std::string> undeclaredNoData(const EsriGrid& grid, const std::string& how) {
    std::vector<std::string> warnings;
    for (const double number : kUsual) {
        const auto count = std::count_if(grid.heights.begin(), grid.heights.end(), [&](double height) {
            return isNumber(height * grid.units.heightsPerLength, number);
        });
        if (count > 0) {
            warnings.push_back(warning(grid.file, count, "cell", number, how));
        }
    }
    return warnings;
}

std::vector<std::string> undeclaredNoData(const Points& points, const std::string& file) {
    std::vector<std::string> warnings;
    for (const double number : kUsual) {
        const auto count =
            std::count_if(points.begin(), points.end(), [&](const auto& point) { return isNumber(point[2], number); });
        if (count > 0) {
            warnings.push_back(warning(file, count, "point", number, "leave such lines out if it does"));
        }
    }
    return warnings;
}

}  // namespace scene
