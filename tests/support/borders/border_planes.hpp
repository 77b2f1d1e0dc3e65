// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

#include "scene/model/material.hpp"
#include "tests/support/borders/border_experiments.hpp"

/// O5 at borders: inclined planes of dry, banded, humid and cohesive sand against closed rims, walls and rock faces.
namespace borders {

/// Sand whose thresholds come from a material, as for a scene file.
struct Sand {
    std::string name;
    scene::Material material;

    /// Returns the slope at which sand stops (first) and the slope from which sand at rest starts to slide (second).
    [[nodiscard]] std::pair<double, double> slopes() const {
        const sand::Tuning tuning = scene::tuningOf(material, {sand::Scheme::isotropic, 60, 1.0, 64});
        constexpr double kUnits = sand::kUnitsPerCell;
        return {tuning.threshold / kUnits, tuning.startThreshold / kUnits};
    }
};
inline std::array<Sand, 4> sands() {
    std::array<Sand, 4> all{{{"dry", {}}, {"with a band", {}}, {"humid", {}}, {"cohesive", {}}}};
    for (Sand& sand : all) {
        sand.material.band = 0;
    }
    all[1].material.band = 0.2;
    all[2].material.humidity = 0.5;
    all[3].material.humidity = 0.5;
    all[3].material.cohesionLength = 2.8;  // a step of 1.4 cells stands
    return all;
}

inline Case caseOf(const Ground& ground, int n, const Sand& sand) {
    Case given = caseOf(ground, n);
    std::tie(given.talus, given.start) = sand.slopes();
    given.sweeps = 4 * given.sweeps;
    return given;
}

/// Returns the volume [cell³] that a step moves in sand that is a plane. The plane has `share` of the slope from which
/// it starts to slide, and rises in the direction `degrees` from east. A wall or a rock face is west of it. With
/// `corners`, a wall with many corners crosses the field, too.
inline double movedOfPlane(const Ground& ground, int n, Face face, const Sand& sand, double degrees, bool corners,
                           double share) {
    Case given = caseOf(ground, n, sand);
    putFace(given, face);
    const double slope = share * given.start, angle = degrees / 57.29577951;
    const double lowest = std::min(n * std::cos(angle), 0.0);  // so that no part of the plane is below the rock
    given.height = [=](double x, double y) { return slope * (x * std::cos(angle) + y * std::sin(angle) - lowest); };
    if (corners) {
        given.wall = [n](int x, int y) { return x == kFaceCells - 1 || (x > n / 2 && 2 * y / 3 == x / 2); };
    }
    sand::Replica replica(sceneOf(given));
    const sand::Replica before = replica;
    Hand(replica).hover();
    return misplaced(replica, [&](double x, double y) { return heightAt(before, x, y); });
}

/// Returns the error of the slope at which a plane stops, as a share of the talus. The plane is a quarter steeper than
/// the slope from which it starts to slide. It leans against the face, or with `along`, it rises along the face. It
/// must turn about its middle until it is as steep as the talus.
inline double errorOfSlidPlane(const Ground& ground, int n, Face face, const Sand& sand, bool along) {
    Case given = caseOf(ground, n, sand);
    const double west = putFace(given, face);
    const double length = along ? n : n - west;
    const oracles::TiltedPlane plane(length, 1.25 * given.start, given.talus);
    const auto onSlope = [=](double x, double y) { return along ? y : x - west; };
    given.height = [&](double x, double y) { return x < west ? 0 : plane.start(onSlope(x, y)); };
    sand::Replica replica(sceneOf(given));
    if (!Hand(replica).rest()) {
        return 1;
    }
    const auto isSand = [=](double x, double) { return x > west; };
    const double tilted = given.talus * length * length / 4 * (along ? n - west : n);  // from level sand to the plane
    return misplaced(
               replica, [&](double x, double y) { return plane.rest(onSlope(x, y)); }, isSand) /
           tilted;
}

/// The method of images, while sand moves and at rest. Sand leans against a face in the west. Another field without a
/// face holds the same sand in its eastern half, and its mirror image in the west. The two are compared.
struct Image {
    double moving = 0;       // the largest difference after a step [cell³ at n = 64]
    double atRest = 0;       // the difference at rest; infinite if the sand does not come to rest
    double mirrorError = 0;  // the difference at rest between the western and the eastern half of the whole field
    double moved = 0;        // the volume that has moved in the half
};
inline Image mirrored(const Ground& ground, int n, Face face, const Sand& sand) {
    const double scale = n / 64.0;
    Case given = caseOf(ground, n, sand);
    const int west = static_cast<int>(putFace(given, face)), width = n - west;
    const double steep = 1.25 * given.start;
    // A slope across the field's axes, a part of a cylinder, and a prism that leans against the face.
    const auto height = [=](double x, double y) {
        const double slope = steep * (0.92 * x + 0.38 * std::abs(y - 0.7 * n));
        const double round = std::hypot(x, y - n / 3.0) < 12 * scale ? 10 * scale : 0;
        return std::min(slope, 20 * scale) + round + (x < 9 * scale && y < n / 6.0 ? 12 * scale : 0);
    };
    given.height = [=](double x, double y) { return x < west ? 0 : height(x - west, y); };
    sand::Replica half(sceneOf(given));
    given.columns = 2 * width;
    given.wall = {};
    if (given.rock) {
        given.rock = [](double, double) { return 0.0; };
    }
    given.height = [=](double x, double y) { return height(std::abs(x - width), y); };
    sand::Replica whole(sceneOf(given));
    const sand::Replica before = half;
    const auto isSand = [=](double x, double) { return x > west; };
    const auto apart = [&](const auto& right) { return misplaced(half, right, isSand) / scale / scale / scale; };
    const auto image = [&](double x, double y) { return heightAt(whole, width + x - west, y); };
    Image result;
    for (int step = 0; step < 20; ++step) {
        Hand(half).hover();
        Hand(whole).hover();
        result.moving = std::max(result.moving, apart(image));
    }
    const bool rests = Hand(half).rest() && Hand(whole).rest();
    result.atRest = rests ? apart(image) : std::numeric_limits<double>::infinity();
    result.moved = apart([&](double x, double y) { return heightAt(before, x, y); }) / 2;
    const auto isWest = [=](double x, double) { return x < width; };
    const auto opposite = [&](double x, double y) { return heightAt(whole, 2 * width - x, y); };
    result.mirrorError = misplaced(whole, opposite, isWest) / scale / scale / scale;
    return result;
}

}  // namespace borders
