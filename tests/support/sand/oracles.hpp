// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "sand/model/height_field.hpp"

/// Piles whose rest state is known in closed form, O1 to O5, and the distance of a field from one.
///
/// Lengths and heights are in cells. `talus` is the tangent of the angle of repose. A profile is any function of a
/// point (x, y), where cell (i, j) covers [i, i + 1] x [j, j + 1]. A field holds the mean of the profile over each
/// cell.
namespace oracles {

/// O1: sand released from a standing cylinder. A low cylinder becomes a frustum with a flat top, a tall one a cone.
class Cylinder {
public:
    Cylinder(double radius, double height, double talus = 1) : radius_(radius), height_(height), talus_(talus) {
        const double ramp = height / talus;  // width of the slope, seen from above
        if (height <= std::numbers::sqrt3 * talus * radius) {
            apex_ = height;
            foot_ = ramp / 2 + std::sqrt(radius * radius - ramp * ramp / 12);
        } else {
            foot_ = std::cbrt(3 * radius * radius * ramp);
            apex_ = talus * foot_;
        }
    }

    [[nodiscard]] double volume() const { return std::numbers::pi * radius_ * radius_ * height_; }
    [[nodiscard]] double start(double r) const { return r < radius_ ? height_ : 0; }
    [[nodiscard]] double rest(double r) const { return std::clamp(talus_ * (foot_ - r), 0.0, apex_); }
    [[nodiscard]] double apex() const { return apex_; }
    [[nodiscard]] double foot() const { return foot_; }                  // radius at the ground
    [[nodiscard]] double top() const { return foot_ - apex_ / talus_; }  // radius of the flat top, 0 for a cone
    [[nodiscard]] double radiusAt(double z) const { return foot_ - z / talus_; }  // for z in (0, apex)

private:
    double radius_, height_, talus_;
    double apex_, foot_;
};

/// O2: sand released from an endless wall that reaches `halfWidth` to either side of a line. `s` is the distance from
/// that line. A low wall keeps a flat top, and a tall one becomes a roof. A wall across the grid's axes must end. It
/// rests in this shape far from its ends. For a tall wall, whose ends slide furthest, that is about 3 foot() away from
/// them.
class Prism {
public:
    Prism(double halfWidth, double height, double talus = 1) : halfWidth_(halfWidth), height_(height), talus_(talus) {
        const bool flat = height <= 2 * talus * halfWidth;
        foot_ = flat ? halfWidth + height / (2 * talus) : std::sqrt(2 * halfWidth * height / talus);
        apex_ = flat ? height : talus * foot_;
    }

    [[nodiscard]] double start(double s) const { return std::abs(s) < halfWidth_ ? height_ : 0; }
    [[nodiscard]] double rest(double s) const { return std::clamp(talus_ * (foot_ - std::abs(s)), 0.0, apex_); }
    [[nodiscard]] double area() const { return 2 * halfWidth_ * height_; }  // of the cross-section
    [[nodiscard]] double apex() const { return apex_; }
    [[nodiscard]] double foot() const { return foot_; }

private:
    double halfWidth_, height_, talus_;
    double apex_, foot_;
};

/// O3: sand poured on one spot. It becomes a cone: R = (3 V / (pi g))^(1/3).
class PouredCone {
public:
    explicit PouredCone(double volume, double talus = 1)
        : talus_(talus), foot_(std::cbrt(3 * volume / (std::numbers::pi * talus))) {}

    [[nodiscard]] double rest(double r) const { return std::max(talus_ * (foot_ - r), 0.0); }
    [[nodiscard]] double apex() const { return talus_ * foot_; }
    [[nodiscard]] double foot() const { return foot_; }

private:
    double talus_, foot_;
};

/// O4: the largest pile on an open table: talus x distance to the nearest rim. On a grid its height is 0 half a cell
/// beyond the field's edge, where the centres of the next cells would be. On a TIN its height is 0 at the edge itself.
class OpenTable {
public:
    OpenTable(double columns, double rows, double talus = 1, double beyond = 0.5 /* [cell] */)
        : columns_(columns), rows_(rows), talus_(talus), beyond_(beyond) {}

    [[nodiscard]] double rest(double x, double y) const {
        const double toRim = std::min(std::min(x, columns_ - x), std::min(y, rows_ - y));
        return talus_ * (toRim + beyond_);
    }

private:
    double columns_, rows_, talus_, beyond_;
};

/// O5: a plane that rises along x from 0 by `slope` per cell in a closed box. Up to the talus it stays. A steeper plane
/// turns about its centroid until it is as steep as the talus.
class TiltedPlane {
public:
    TiltedPlane(double columns, double slope, double talus = 1) : columns_(columns), slope_(slope), talus_(talus) {}

    [[nodiscard]] double start(double x) const { return slope_ * x; }
    [[nodiscard]] double rest(double x) const {
        return slope_ * columns_ / 2 + std::min(slope_, talus_) * (x - columns_ / 2);
    }

private:
    double columns_, slope_, talus_;
};

/// A straight line through (x0, y0), turned by `degrees` from the y axis, for prisms across the grid's axes.
struct Line {
    double x0, y0, degrees;
    [[nodiscard]] double across(double x, double y) const {
        const double angle = degrees * std::numbers::pi / 180;
        return (x - x0) * std::cos(angle) + (y - y0) * std::sin(angle);
    }
    [[nodiscard]] double along(double x, double y) const {
        const double angle = degrees * std::numbers::pi / 180;
        return (y - y0) * std::cos(angle) - (x - x0) * std::sin(angle);
    }
};

/// Returns a profile of (x, y) from one of the distance from (x0, y0).
template <class Radial>
auto around(double x0, double y0, Radial radial) {
    return [=](double x, double y) { return radial(std::sqrt((x - x0) * (x - x0) + (y - y0) * (y - y0))); };
}

/// Returns the mean of a profile over a cell, from kSub x kSub samples.
template <int kSub = 8, class Profile>
double meanOverCell(int column, int row, const Profile& profile) {
    double sum = 0;
    for (int s = 0; s < kSub * kSub; ++s) {
        const int east = s % kSub, north = s / kSub;
        sum += profile(column + (east + 0.5) / kSub, row + (north + 0.5) / kSub);
    }
    return sum / (kSub * kSub);
}

/// Returns the means of a profile over the cells of a columns x rows field, row by row from the south.
template <int kSub = 8, class Profile>
std::vector<double> sampled(int columns, int rows, const Profile& profile) {
    std::vector<double> means;
    means.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            means.push_back(meanOverCell<kSub>(column, row, profile));
        }
    }
    return means;
}

/// Returns a field that holds a profile. It takes 16 x 16 samples per cell, so that the area of a round footprint is
/// right within 1e-5.
template <class Profile>
sand::HeightField fieldOf(int columns, int rows, const Profile& profile) {
    sand::HeightField field(columns, rows, 1.0);
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const double units = sand::kUnitsPerCell * meanOverCell<16>(column, row, profile);
            field.setHeight(column, row, static_cast<std::int32_t>(std::floor(units + 0.5)));
        }
    }
    return field;
}

/// The distance of heights from the expected ones.
struct Distance {
    double misplaced = 0;  // sum of |error| over the sum of |expected|: the share of sand in the wrong place
    double largest = 0;    // [cell], L-infinity
    double apex = 0;       // [cell], highest height found minus highest expected, signed
};

/// Compares the cells for which `counts(column, row)` is true. `height(i)` and `expected[i]` are in cells, row by row.
template <class Height, class Counts>
Distance distance(int columns, const std::vector<double>& expected, const Height& height, const Counts& counts) {
    Distance result;
    double sum = 0;
    double total = 0;
    double highest = -1e300;
    double highestExpected = -1e300;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const int column = static_cast<int>(i % static_cast<std::size_t>(columns));
        const int row = static_cast<int>(i / static_cast<std::size_t>(columns));
        if (counts(column, row)) {
            const double error = std::abs(height(i) - expected[i]);
            sum += error;
            total += std::abs(expected[i]);
            result.largest = std::max(result.largest, error);
            highest = std::max(highest, height(i));
            highestExpected = std::max(highestExpected, expected[i]);
        }
    }
    result.misplaced = total > 0 ? sum / total : sum;
    result.apex = highest - highestExpected;
    return result;
}

/// Compares a field with means of the same size, in the cells for which `counts` is true.
template <class Counts>
Distance distance(const sand::HeightField& field, const std::vector<double>& expected, const Counts& counts) {
    const int columns = field.columns();
    const auto height = [&](std::size_t i) {
        const auto cell = static_cast<int>(i);
        return static_cast<double>(field.height(cell % columns, cell / columns)) / sand::kUnitsPerCell;
    };
    return distance(columns, expected, height, counts);
}

/// Compares every cell of a field with means of the same size.
inline Distance distance(const sand::HeightField& field, const std::vector<double>& expected) {
    return distance(field, expected, [](int, int) { return true; });
}

/// Returns the distance from (x0, y0), in the direction of `degrees`, at which the ground falls below height z [cell].
/// Interpolates between samples of a ray, and bilinearly between cell centres. Returns 0 if the ray is nowhere above z.
inline double radiusAt(const sand::HeightField& field, double x0, double y0, double degrees, double z) {
    const double dx = std::cos(degrees * std::numbers::pi / 180);
    const double dy = std::sin(degrees * std::numbers::pi / 180);
    const auto at = [&](double r) {
        const double x = std::clamp(x0 + r * dx - 0.5, 0.0, field.columns() - 1.001);
        const double y = std::clamp(y0 + r * dy - 0.5, 0.0, field.rows() - 1.001);
        const int i = static_cast<int>(x);
        const int j = static_cast<int>(y);
        const double fx = x - i;
        const double fy = y - j;
        const auto h = [&](int a, int b) { return static_cast<double>(field.height(a, b)) / sand::kUnitsPerCell; };
        return (1 - fy) * ((1 - fx) * h(i, j) + fx * h(i + 1, j)) +
               fy * ((1 - fx) * h(i, j + 1) + fx * h(i + 1, j + 1));
    };
    constexpr double kStep = 0.125;  // [cell]
    double r = std::hypot(field.columns(), field.rows()) / 2;
    while (r > 0) {
        const double inward = r - kStep;
        if (const double above = at(inward); above >= z) {
            const double below = at(r);
            return inward + kStep * (above - z) / std::max(above - below, 1e-12);
        }
        r = inward;
    }
    return 0;
}

}  // namespace oracles
