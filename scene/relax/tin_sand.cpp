// SPDX-License-Identifier: Apache-2.0
#include "scene/relax/tin_sand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/input_error.hpp"
#include "base/text.hpp"
#include "scene/relax/slivers.hpp"

namespace scene::relax {
namespace {

using sand::tin::LatticePoint;
using sand::tin::Vertex;

constexpr double kStepsAcross = 524288;    // steps of the lattice on the longer side of a cloud, about: 2^19
constexpr double kFineSteps = 64;          // largest ratio of a step to the power of two that divides step and corner
constexpr double kLeastDeep = 64;          // [lattice step]
constexpr double kMostTinVolume = 4.6e18;  // [volume unit], of all sand: below 2^62
constexpr int kStepsPerCell = sand::tin::kLatticePerCell;

struct Extent {
    std::array<double, 3> least{}, most{};
    [[nodiscard]] double side(std::size_t axis) const { return most.at(axis) - least.at(axis); }
};

Extent extentOf(const Points& points) {
    Extent extent{points.at(0), points.at(0)};
    for (const auto& point : points) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            extent.least.at(axis) = std::min(extent.least.at(axis), point.at(axis));
            extent.most.at(axis) = std::max(extent.most.at(axis), point.at(axis));
        }
    }
    return extent;
}

/// Lattice of points, from its south-west corner.
struct Lattice : ExactLattice {
    std::int32_t width = 0, depth = 0;

    [[nodiscard]] LatticePoint placeOf(const std::array<double, 3>& point) const {
        const auto on = [this](double length, std::int32_t most) {
            return std::min(static_cast<std::int32_t>(std::floor(length / step + 0.5)), most);
        };
        return {on(point[0] - west, width), on(point[1] - south, depth)};
    }
};

/// Returns a step that is at least `least` and at most 1/32 longer. The second number is a power of two; the step is a
/// multiple of it. If the corner is also a multiple of that power, no place of the lattice is rounded.
std::pair<double, double> exactStep(double least) {
    int exponent = 0;
    const double part = std::frexp(least, &exponent);
    const double fine = std::ldexp(1 / kFineSteps, exponent);
    return {std::ceil(part * kFineSteps) * fine, fine};
}

/// Returns the lattice of a cloud. Its step is no finer than the resolution of doubles for these coordinates.
Lattice latticeOf(const Extent& extent) {
    const double longer = std::max(extent.side(0), extent.side(1));
    double farthest = 0;
    for (const std::size_t axis : {0U, 1U}) {
        farthest = std::max({farthest, std::abs(extent.least.at(axis)), std::abs(extent.most.at(axis))});
    }
    const double rounding = std::nextafter(farthest, HUGE_VAL) - farthest;
    const auto [step, fine] = exactStep(std::max(longer / kStepsAcross, kFineSteps * rounding));
    return {{std::floor(extent.least[0] / fine) * fine, std::floor(extent.least[1] / fine) * fine, step}, 0, 0};
}

Lattice latticeOf(const Extent& extent, const std::string& file, std::optional<double> step) {
    const double longer = std::max(extent.side(0), extent.side(1)), shorter = std::min(extent.side(0), extent.side(1));
    Lattice lattice = step ? Lattice{{extent.least[0], extent.least[1], *step}, 0, 0} : latticeOf(extent);
    if (!std::isnormal(lattice.step) || !std::isnormal(lattice.step * lattice.step)) {
        throw base::InputError(fmt::format("{}: it is {} long, which cannot be a length of terrain", file, longer));
    }
    if (!step && shorter < kLeastDeep * lattice.step) {
        throw base::InputError(
            fmt::format("{}: all points lie in a strip {} long and {} wide; a TIN takes at most 1 : {}", file, longer,
                        shorter, kStepsAcross / kLeastDeep));
    }
    lattice.width = static_cast<std::int32_t>(std::floor((extent.most[0] - lattice.west) / lattice.step + 0.5));
    lattice.depth = static_cast<std::int32_t>(std::floor((extent.most[1] - lattice.south) / lattice.step + 0.5));
    return lattice;
}

/// Returns the finest unit in which all volumes over the field fit. The candidates halve a nominal cell repeatedly.
HeightScale scaleOf(const Extent& extent, const Lattice& lattice, const std::string& file) {
    const double lowest = extent.least[2], highest = extent.most[2];
    const double area = 6.0 * lattice.width * lattice.depth;
    const double most = std::min(kMostTinVolume / area, static_cast<double>(sand::kMaxHeight));
    HeightScale scale = HeightScale::finest(lattice.step * kStepsPerCell, lowest, highest);
    while (scale.bits >= 0 && (highest - lowest) / scale.unit > most) {
        --scale.bits;
        scale.unit *= 2;
    }
    if (scale.bits < 0) {
        throw base::InputError(
            fmt::format("{}: heights from {} to {} span more than a TIN of this extent can hold, "
                        "{:.3g}; are all of them heights of terrain?",
                        file, lowest, highest, most * lattice.step * kStepsPerCell));
    }
    // The datum is in the middle of the heights, so that no volume is larger than necessary.
    scale.datum = scale.unit * std::floor((lowest / 2 + highest / 2) / scale.unit + 0.5);
    return scale;
}

void setThresholds(const std::string& file, const TalusSettings& material, TinSand& sand) {
    const double slope = std::tan(material.talusDegrees * std::numbers::pi / 180);
    const double exact = slope * sand.step * kStepsPerCell / sand.scale.unit;
    constexpr double kLargest = 1073741824.0;  // [unit]; no difference between heights is larger
    const double threshold = std::min(std::floor(exact + 0.5), kLargest);
    if (threshold < kLeastThreshold && material.talusDegrees != 0) {
        throw base::InputError(fmt::format(
            "{}: a talus of {} degrees is {} height units of {:.4g} on {:.4g}, and {} is the least, except for 0 "
            "degrees; "
            "heights span too much for this extent: are all of them heights of terrain?",
            file, material.talusDegrees, threshold, sand.scale.unit, sand.step * kStepsPerCell, kLeastThreshold));
    }
    sand.threshold = static_cast<std::int32_t>(threshold);
    sand.startThreshold = static_cast<std::int32_t>(std::min(std::floor(threshold * (1 + material.band)), kLargest));
}

/// A mesh of all points, with the point of each vertex. If several points share a place, it is the first.
struct Joined {
    sand::tin::Mesh mesh;
    std::vector<std::array<double, 3>> points;  // one per vertex
    std::vector<Vertex> cornersAdded;
    std::size_t near = 0;   // points at the place of an earlier point
    double nearHeight = 0;  // largest difference in height between two points at one place
};

Joined join(const Points& points, const Extent& extent, const Lattice& lattice, const Thinned* raster) {
    std::vector<LatticePoint> places;
    places.reserve(points.size());
    for (const auto& point : points) {
        places.push_back(lattice.placeOf(point));
    }
    Joined joined{.mesh = sand::tin::Mesh(lattice.width, lattice.depth, raster == nullptr ? nullptr : raster->holes),
                  .points = {},
                  .cornersAdded = {}};
    const std::vector<Vertex> vertices = joined.mesh.insert(places);
    if (raster != nullptr) {
        for (const auto& [a, b] : raster->outline) {
            joined.mesh.constrain(vertices[static_cast<std::size_t>(a)], vertices[static_cast<std::size_t>(b)]);
        }
    }
    const std::size_t count = joined.mesh.triangles().places.size();
    joined.points.resize(count);
    std::vector<bool> known(count);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto vertex = static_cast<std::size_t>(vertices[i]);
        if (known[vertex]) {
            ++joined.near;
            joined.nearHeight = std::max(joined.nearHeight, std::abs(points[i][2] - joined.points[vertex][2]));
            continue;
        }
        known[vertex] = true;
        joined.points[vertex] = points[i];
    }
    for (std::size_t corner = 0; corner < 4; ++corner) {
        if (!known[corner]) {
            const LatticePoint at = joined.mesh.triangles().places[corner];
            const auto squared = [&](const LatticePoint& place) {
                const std::int64_t x = std::int64_t{place.x} - at.x, y = std::int64_t{place.y} - at.y;
                return x * x + y * y;
            };
            const auto nearest =
                std::min_element(places.begin(), places.end(),
                                 [&](const LatticePoint& a, const LatticePoint& b) { return squared(a) < squared(b); });
            joined.points[corner] = {at.x == 0 ? extent.least[0] : extent.most[0],
                                     at.y == 0 ? extent.least[1] : extent.most[1],
                                     points[static_cast<std::size_t>(nearest - places.begin())][2]};
            joined.cornersAdded.push_back(static_cast<Vertex>(corner));
        }
    }
    return joined;
}

TinSand sandOf(const Points& points, const std::string& file, const TalusSettings& material, std::optional<double> step,
               const Thinned* raster) {
    if (points.size() > static_cast<std::size_t>(kMostVertices)) {
        throw base::InputError(fmt::format("{}: {} points, but a TIN takes at most {}; thin them out", file,
                                           points.size(), kMostVertices));
    }
    const Extent extent = extentOf(points);
    const Lattice lattice = latticeOf(extent, file, step);
    const HeightScale scale = scaleOf(extent, lattice, file);
    Joined joined = join(points, extent, lattice, raster);
    if (raster == nullptr) {
        joined.mesh.takeGroundOut(sliversAtRim(joined.mesh.triangles()));
    }
    const int moved = keepCounterClockwise(joined.mesh.triangles(), lattice, joined.points);
    TinSand sand{.layer = sand::tin::VertexSand(std::move(joined.mesh)),
                 .step = lattice.step,
                 .scale = scale,
                 .points = std::move(joined.points),
                 .volumes = {},
                 .lowest = scale.toUnits(extent.least[2]),
                 .cornersAdded = 0,
                 .placesMoved = moved,
                 .warnings = {}};
    for (const Vertex corner : joined.cornersAdded) {
        sand.cornersAdded += sand.layer.stars()[static_cast<std::size_t>(corner)] > 0 ? 1 : 0;
    }
    setThresholds(file, material, sand);
    for (std::size_t i = 0; i < sand.points.size(); ++i) {
        sand.layer.setHeight(static_cast<Vertex>(i), scale.toUnits(sand.points[i][2]));
    }
    sand.volumes = sand.layer.volumes();
    if (joined.near > 0) {
        sand.warnings.push_back(fmt::format(
            "{}: {} points lie within {:.3g} of another, which a TIN of this extent cannot separate; the first in the "
            "file was taken, others were up to {:.3g} higher or lower",
            file, joined.near, lattice.step, joined.nearHeight));
    }
    return sand;
}

}  // namespace

bool holdsPoints(const std::filesystem::path& file) {
    const std::string ending = base::endingOf(file);
    return ending == ".csv" || ending == ".xyz";
}

TinSand toTin(const Points& points, const std::string& file, const TalusSettings& material) {
    return sandOf(points, file, material, {}, nullptr);
}

TinSand toTin(const Thinned& thinned, const std::string& file, const TalusSettings& material) {
    return sandOf(thinned.points, file, material, thinned.step, &thinned);
}

std::int64_t TinSand::volume() const { return static_cast<std::int64_t>(layer.volume() - layer.ground() * lowest); }

Mesh TinSand::toMesh() const {
    Mesh mesh;
    std::vector<std::uint32_t> numbers(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (layer.stars()[i] == 0) {  // a vertex of holes alone
            continue;
        }
        numbers[i] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(points[i]);
        if (layer.volumes()[i] != volumes[i]) {
            mesh.vertices.back()[2] = withFewDecimals(scale.datum + layer.heights()[i] * scale.unit, scale.unit);
        }
    }
    for (const sand::tin::Triangle& triangle : layer.triangles().triangles) {
        if (triangle.isGround()) {
            const auto number = [&](std::size_t k) { return numbers[static_cast<std::size_t>(triangle.corner.at(k))]; };
            mesh.triangles.push_back({number(0), number(1), number(2)});
        }
    }
    return mesh;
}

Steepness steepnessOf(const Mesh& mesh, double talus) {
    Steepness result;
    double steep = 0, all = 0;  // [doubled area]
    for (const auto& [first, second, third] : mesh.triangles) {
        const auto &a = mesh.vertices[first], &b = mesh.vertices[second], &c = mesh.vertices[third];
        const double eastOfB = b[0] - a[0], northOfB = b[1] - a[1], rise = b[2] - a[2];
        const double eastOfC = c[0] - a[0], northOfC = c[1] - a[1], other = c[2] - a[2];
        const double area = eastOfB * northOfC - northOfB * eastOfC;
        const double slope = std::hypot(rise * northOfC - other * northOfB, other * eastOfB - rise * eastOfC) / area;
        result.steepest = std::max(result.steepest, slope);
        all += area;
        steep += slope > 1.01 * talus ? area : 0;
    }
    result.tooSteepArea = steep / all;
    return result;
}

}  // namespace scene::relax
