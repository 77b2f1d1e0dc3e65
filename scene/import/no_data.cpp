// SPDX-License-Identifier: Apache-2.0
#include "scene/import/no_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/input_error.hpp"

namespace scene {
namespace {

// Default of ESRI and GDAL, elevation tiles of 16 bits, and the number of some surveys.
constexpr std::array<double, 3> kUsual{-9999, -32768, -99999};

/// Returns whether a height is `number`. Dividing it by a unit and multiplying it again causes at most two roundings.
bool isNumber(double height, double number) { return std::abs(height - number) <= 1e-15 * std::abs(number); }

/// Size of the largest 32-bit float, as programs round it up or down that print few digits.
constexpr double kLargestFloat = 3.4028234663852886e38;
constexpr double kSurfer = 1.70141e38;  // "blanked" in Surfer
bool isNear(double number, double other) { return std::abs(std::abs(number) - other) <= 1e-5 * other; }
bool isLargest(double number) { return isNear(number, kLargestFloat); }

/// Returns whether a number cannot be a height in any unit, and means no data in many programs.
bool cannotBeAHeight(double number) {
    return isLargest(number) || isNear(number, kSurfer) || std::abs(number) == std::numeric_limits<double>::max();
}

/// Throws base::InputError for heights that cannot be heights. `heights` are in the file's unit. The line ends with
/// `how`, in which {0} stands for the number.
template <class Heights, class HeightOf>
void refuseLargest(const Heights& heights, HeightOf heightOf, const std::string& file, const char* what,
                   const std::string& how) {
    const auto found = [&](const auto& one) { return cannotBeAHeight(heightOf(one)); };
    const auto first = std::find_if(heights.begin(), heights.end(), found);
    if (first != heights.end()) {
        const auto count = std::count_if(first, heights.end(), found);
        throw base::InputError(fmt::format("{}: {} {}{} the height {}, which means no data; {}", file, count, what,
                                           count == 1 ? " has" : "s have", heightOf(*first),
                                           fmt::format(fmt::runtime(how), heightOf(*first))));
    }
}

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
    constexpr std::string_view kIf = "if it does";
    const std::size_t behind = how.starts_with(kIf) ? how.find_first_not_of(":, ", kIf.size()) : 0;
    refuseLargest(
        grid.heights, [&](double height) { return height * grid.units.heightsPerLength; }, grid.file, "cell",
        "declare it: " + how.substr(behind));
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

std::vector<std::string> undeclaredNoData(const std::vector<std::array<double, 3>>& points, const std::string& file) {
    refuseLargest(
        points, [](const auto& point) { return point[2]; }, file, "point", "leave such lines out");
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
