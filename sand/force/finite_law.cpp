// SPDX-License-Identifier: Apache-2.0
#include "sand/force/finite_law.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "sand/force/law.hpp"
#include "sand/model/tuning.hpp"
#include "sand/model/units.hpp"

namespace sand::force {
namespace {

constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kSmallest = std::numeric_limits<double>::min();
constexpr double kSteepest = 2.0 * kMaxHeight / kUnitsPerCell;  // from the lowest to the highest height within a cell

struct LawPoint {
    double radius, depth;  // [scene unit]
};

/// Returns the places at which a law is checked. The deepest are first.
std::vector<LawPoint> placesIn(const LawRegion& region) {
    std::vector<LawPoint> places;
    const auto add = [&](double depth) {
        // While the depth is less than the radius, the force of Dorjgotov et al. 2007 turns with the depth.
        for (const double radius :
             {region.smallestRadius, depth, depth / 0.75, 2 * depth, 4 * depth, region.largestRadius}) {
            places.push_back({std::clamp(radius, region.smallestRadius, region.largestRadius), depth});
        }
    };
    for (const double length : {region.deepest, region.largestRadius, region.smallestRadius}) {
        for (const double share : {1.0, 0.75, 0.5, 0.25}) {
            add(std::min(share * length, region.deepest));
        }
    }
    add(0);
    return places;
}

/// Returns what the law reads at `place`, on level sand or on the steepest.
Gauges gaugesAt(const ForceConstants& constants, const Contour& tool, const LawPoint& place, bool steep) {
    const double slope = steep ? kSteepest : 0;
    if (constants.law == ForceLaw::repulse) {
        Contact contact;
        contact.depth = {place.depth, {slope, slope, -1}};
        contact.slopeX = contact.slopeY = {slope, {slope / place.radius, slope / place.radius, 0}};
        contact.share = 1;
        return contact.gauges();
    }
    // A control point reads a slope of at most 1. On steep sand only half of the points are in it.
    Gauges gauges;
    gauges.count = tool.points.size();
    for (std::size_t i = 0; i < gauges.count; ++i) {
        const double depth = steep && tool.points[i].x < 0 ? -place.depth : place.depth;
        gauges.dials[i] = (1 / constants.unitLength) * Dual{depth, {std::min(slope, 1.0), 0, -1}};
    }
    return gauges;
}

/// Returns the first place at which the law is not finite.
std::optional<LawPoint> placeNotFinite(const ForceConstants& constants, const LawRegion& region) {
    for (const LawPoint& place : placesIn(region)) {
        const Contour tool = Contour::sphere(place.radius);
        for (const bool steep : {false, true}) {
            if (!isFinite(respond(constants, tool, gaugesAt(constants, tool, place, steep)), region)) {
                return place;
            }
        }
    }
    return std::nullopt;
}

/// A constant that can make a law not finite.
struct Suspect {
    double ForceConstants::*constant;
    bool atMost;      // whether large values are at fault, not small ones
    double harmless;  // a value that is not at fault
};

/// Returns the suspects of the chosen law. The usual culprit is first.
std::vector<Suspect> suspectsOf(ForceLaw law, const LawRegion& region) {
    const ForceConstants usual;
    if (law == ForceLaw::repulse) {  // with an exponent of 0 there is no force
        return {{&ForceConstants::depthExponent, true, 0}};
    }
    return {{&ForceConstants::unitLength, false, region.deepest},
            {&ForceConstants::frictionCoefficient, true, 0},
            {&ForceConstants::frictionSpeed, false, usual.frictionSpeed},
            {&ForceConstants::maxForce, true, 0}};
}

/// Returns a number with three digits, not above `number` or not below it.
double rounded(double number, bool down) {
    const double digits = 2 - std::floor(std::log10(number));
    // A power of ten above 1 is exact, so that the result is the double nearest to its decimal digits.
    const double power = std::pow(10, std::abs(digits));
    const double scaled = digits >= 0 ? number * power : number / power;
    const double whole = down ? std::floor(scaled) : std::ceil(scaled);
    const double result = digits >= 0 ? whole / power : whole * power;
    return std::isfinite(result) && result > 0 ? result : number;
}

/// Returns the value nearest to the present one at which the law is finite. Requires that it is finite at
/// `suspect.harmless` and not at present.
double nearestFinite(ForceConstants constants, const Suspect& suspect, const LawRegion& region) {
    constexpr double kNear = 1e-4;  // log2 of the ratio of two values that count as one
    double bad = std::log2(constants.*suspect.constant);
    double good = std::log2(std::max(suspect.harmless, kSmallest));
    const auto finiteAt = [&](double logarithm) {
        constants.*suspect.constant = std::exp2(logarithm);
        return !placeNotFinite(constants, region);
    };
    if (!finiteAt(good)) {
        return suspect.harmless;
    }
    while (std::abs(bad - good) > kNear) {
        const double middle = (bad + good) / 2;
        (finiteAt(middle) ? good : bad) = middle;
    }
    return rounded(std::exp2(good), suspect.atMost);
}

LawFault faultAt(const ForceConstants& constants, const Suspect& suspect, const LawPoint& place) {
    const auto key = std::find_if(forceKeys().begin(), forceKeys().end(),
                                  [&](const ForceKey& each) { return each.constant == suspect.constant; });
    return {&*key, constants.*suspect.constant, place.radius, place.depth, suspect.atMost, std::nullopt};
}

}  // namespace

LawRegion LawRegion::of(int longerSide, double cellSize) {
    constexpr double kFramesPerSecond = 60;
    const double side = std::min(longerSide * cellSize, kLargest);
    const double scale = std::min(side / kShortestReach, kLargest);
    return {.smallestRadius = probeUnit(cellSize),
            .largestRadius = std::min(cellSize * kLargestToolRadius / kProbePerCell, kLargest),
            .deepest = side,
            .scale = scale,
            .fastest = scale * (kFastest / kFramesPerSecond)};
}

bool isFinite(const Response& felt, const LawRegion& region) {
    const double difference = 2 * (norm(felt.push) + felt.drag * region.fastest);
    return std::isfinite(difference * difference) && std::isfinite(norm(felt.normal)) &&
           std::isfinite(felt.stiffness * region.scale);
}

std::optional<LawFault> faultOf(const ForceConstants& constants, const LawRegion& region) {
    const std::optional<LawPoint> place = placeNotFinite(constants, region);
    if (!place) {
        return std::nullopt;
    }
    ForceConstants mended = constants;
    std::optional<LawFault> first;
    for (const Suspect& suspect : suspectsOf(constants.law, region)) {
        const double value = constants.*suspect.constant;
        if (suspect.atMost ? value <= suspect.harmless : value >= suspect.harmless) {
            continue;
        }
        LawFault fault = faultAt(constants, suspect, *place);
        ForceConstants alone = constants;
        alone.*suspect.constant = mended.*suspect.constant = suspect.harmless;
        if (!placeNotFinite(alone, region)) {
            fault.allowed = nearestFinite(constants, suspect, region);
            return fault;
        }
        first = first ? first : fault;
    }
    return placeNotFinite(mended, region) ? std::nullopt : first;
}

double usualDepthExponent(const ForceConstants& constants, const LawRegion& region) {
    ForceConstants usual = constants;
    usual.depthExponent = ForceConstants{}.depthExponent;
    const std::optional<LawFault> fault = constants.law == ForceLaw::repulse ? faultOf(usual, region) : std::nullopt;
    return fault ? fault->allowed.value_or(0) : usual.depthExponent;
}

}  // namespace sand::force
