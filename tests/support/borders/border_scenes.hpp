// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "sand/tin/refine/start_maker.hpp"
#include "sand/tin/surface.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/sand/sand_of.hpp"

/// Sand at rims, walls, rock faces and holes, as a grid and as a TIN, and what must be true of it. Lengths and heights
/// are in cells.
namespace borders {

/// Tangent of the talus of all scenes, that of 34 degrees.
inline constexpr double kTalus = 0.67450851684242674;

/// Description of a scene. Cell (i, j) covers [i, i + 1] x [j, j + 1], and its height is that of its middle.
struct Case {
    int columns = 64, rows = 64;
    std::function<double(double, double)> height = [](double, double) { return 8.0; };
    std::function<bool(int, int)> wall{};          // cells without data; empty: there are none
    std::function<double(double, double)> rock{};  // height of the rock; empty: there is none
    bool tin = false;
    int widest = 1;              // of the TIN; 0: no limit
    double maxError = 1.0 / 16;  // of the TIN; 0: no vertex is removed
    sand::Rim rim = sand::Rim::closed;
    double talus = kTalus, start = 0;  // tangents; sand at rest starts to slide beyond `start`; 0: the talus
    int sweeps = 8;                    // per step
    sand::ToolKind tool = sand::ToolKind::sphere;
    double radius = 6;
};

inline std::int32_t units(double cells) {
    return static_cast<std::int32_t>(std::floor(cells * sand::kUnitsPerCell + 0.5));
}

inline scene::Scene sceneOf(const Case& given) {
    scene::Scene scene;
    scene.name = "border";
    scene.terrain = sand::HeightField(given.columns, given.rows, 1.0);
    auto ground = std::make_shared<sand::Ground>(given.columns, given.rows);
    for (int y = 0; y < given.rows; ++y) {
        for (int x = 0; x < given.columns; ++x) {
            const double rock = given.rock ? given.rock(x + 0.5, y + 0.5) : 0;
            const double sand = given.height(x + 0.5, y + 0.5);
            scene.terrain.setHeight(x, y, units(given.rock ? std::max(sand, rock) : sand));
            if (given.rock) {
                ground->setBedrock(x, y, units(rock));
            }
            if (given.wall && given.wall(x, y)) {
                ground->setWall(x, y);
            }
        }
    }
    sand::Rules& rules = scene.rules;
    rules.columns = given.columns;
    rules.rows = given.rows;
    rules.tuning.threshold = units(given.talus);
    rules.tuning.startThreshold = std::max(rules.tuning.threshold, units(given.start));
    rules.tuning.sweepsPerStep = given.sweeps;
    rules.stepsPerSecond = 60;
    rules.rim = given.rim;
    rules.tuning.tool.kind = given.tool;
    rules.tuning.tool.radius = static_cast<std::int32_t>(given.radius * sand::kProbePerCell);
    rules.tuning.tool.halfWidth =
        sand::isRound(given.tool) ? 0
                                  : static_cast<std::int32_t>(rules.tuning.tool.radius * sand::usualWidth(given.tool));
    if (given.tin) {
        sand::tin::Settings settings;
        settings.maxError = units(given.maxError);
        settings.widest = given.widest * sand::kProbePerCell;
        settings.mostVertices = 1 << 20;
        scene.beginAs(sand::tin::follow(scene.terrain, given.wall ? ground.get() : nullptr, settings, given.rim).start);
    } else if (given.wall || given.rock) {
        scene.ground = ground;
        rules.ground = ground->digest();
    }
    return scene;
}

inline sand::ProbePoint probeAt(double x, double y, double z) {
    const auto probe = [](double cells) {
        return static_cast<std::int32_t>(std::floor(cells * sand::kProbePerCell + 0.5));
    };
    return {probe(x), probe(y), probe(z)};
}

/// Numbers the steps of one replica and applies them.
class Hand {
public:
    explicit Hand(sand::Replica& sand) : sand_(sand) {}

    void apply(bool engaged, std::vector<sand::ProbePoint> path, const sand::Edit& edit = sand::Edit::none) {
        sand_.apply(
            {.epoch = 1, .number = sand_.stepNumber() + 1, .engaged = engaged, .path = std::move(path), .edit = edit});
    }
    void hover(const sand::Edit& edit = sand::Edit::none) { apply(false, {}, edit); }
    void hold(const sand::Edit& edit = sand::Edit::none) { apply(true, {}, edit); }
    void press(double x, double y, double z) { apply(true, {probeAt(x, y, z)}); }
    /// Drags at one and a half cells per step.
    void drag(double x0, double y0, double x1, double y1, double z) {
        const int steps = std::max(1, static_cast<int>(std::ceil(std::hypot(x1 - x0, y1 - y0) / 1.5)));
        for (int i = 0; i <= steps; ++i) {
            const double way = static_cast<double>(i) / steps;
            press(x0 + way * (x1 - x0), y0 + way * (y1 - y0), z);
        }
    }
    /// Hovers until all sand is at rest. Returns false if it is not at rest after `most` steps.
    bool rest(int most = 20000) {
        hover();
        for (int i = 0; i < most && !sand_.settled(); ++i) {
            hover();
        }
        return sand_.settled();
    }

private:
    sand::Replica& sand_;
};

/// Returns the height of the surface at a place.
inline double heightAt(const sand::Replica& sand, double x, double y) {
    return sand.surface().height(x * sand::kProbePerCell, y * sand::kProbePerCell) / sand::kUnitsPerCell;
}

/// Returns the heights at the middles of all cells, row by row.
inline std::vector<double> heightsOf(const sand::Replica& sand) {
    std::vector<double> heights;
    for (int y = 0; y < sand.rules().rows; ++y) {
        for (int x = 0; x < sand.rules().columns; ++x) {
            heights.push_back(heightAt(sand, x + 0.5, y + 0.5));
        }
    }
    return heights;
}

/// Returns half the sum of |change|, from one result of heightsOf() to another [cell³].
inline double moved(const std::vector<double>& from, const std::vector<double>& to) {
    double sum = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        sum += std::abs(to[i] - from[i]) / 2;
    }
    return sum;
}

/// Returns the volume between the surface and `right(x, y)` [cell³], from the heights at the middles of the cells.
/// Counts only cells for which `counts(x, y)` is true.
template <class Right, class Counts>
double misplaced(const sand::Replica& sand, const Right& right, const Counts& counts) {
    double sum = 0;
    for (int y = 0; y < sand.rules().rows; ++y) {
        for (int x = 0; x < sand.rules().columns; ++x) {
            if (counts(x + 0.5, y + 0.5)) {
                sum += std::abs(heightAt(sand, x + 0.5, y + 0.5) - right(x + 0.5, y + 0.5));
            }
        }
    }
    return sum;
}
template <class Right>
double misplaced(const sand::Replica& sand, const Right& right) {
    return misplaced(sand, right, [](double, double) { return true; });
}

/// Returns whether a place is so far within a tool that the outline in a mesh holds it, because this outline is a
/// polygon. The outline holds 0.98 of the tool. That of a foot holds 0.98 of each piece of the sole, less two probe
/// units (docs/tin.md).
inline bool isWithinOutline(const sand::TurnedShape& turned, const sand::Tool& tool, const sand::Offset& offset) {
    const auto sole = sand::solePieces(tool.kind);
    if (sole.empty()) {
        return turned.covers({offset.x * 50 / 49, offset.y * 50 / 49});
    }
    const double east = tool.heading.x, north = tool.heading.y, length = std::hypot(east, north);
    const auto x = static_cast<double>(offset.x), y = static_cast<double>(offset.y);
    const double along = (x * east + y * north) / length;
    const double across = (tool.heading.mirrored ? -1 : 1) * (y * east - x * north) / length;
    return std::any_of(sole.begin(), sole.end(), [&](const sand::SolePiece& piece) {
        return std::hypot((along - piece.along * tool.radius) / (0.98 * piece.halfLength * tool.radius - 2),
                          (across - piece.across * tool.halfWidth) / (0.98 * piece.halfWidth * tool.halfWidth - 2)) < 1;
    });
}

/// Returns how far the surface is above the underside of a tool at `probe`, at the centres of cells, and on a lattice
/// of quarter cells of a TIN. Counts only places on ground, and on a TIN only those that the outline in a mesh holds.
inline double overUnderside(const sand::Replica& sand, const sand::ProbePoint& probe) {
    const sand::TurnedShape turned(sand.tool());
    const bool tin = sand.rules().tin != 0;
    const int step = tin ? sand::kProbePerCell / 4 : sand::kProbePerCell;
    double most = 0;
    const auto holes = tin ? dynamic_cast<const sand::tin::TinSurface&>(sand.surface()).start().holes : nullptr;
    const sand::Ground* const ground = tin ? nullptr : std::get<sand::GridData>(sand.surface().data()).ground;
    for (std::int32_t y = step / 2; y < sand.rules().rows * sand::kProbePerCell; y += step) {
        for (std::int32_t x = step / 2; x < sand.rules().columns * sand::kProbePerCell; x += step) {
            const sand::Offset offset{std::int64_t{x} - probe.x, std::int64_t{y} - probe.y};
            if (std::max(std::abs(offset.x), std::abs(offset.y)) > sand.tool().radius ||
                !(tin ? isWithinOutline(turned, sand.tool(), offset) : turned.covers(offset)) ||
                (holes != nullptr && holes->holds({x, y})) ||
                (ground != nullptr && ground->isWall(x / sand::kProbePerCell, y / sand::kProbePerCell))) {
                continue;
            }
            const double under = static_cast<double>(turned.underside(probe.z, offset));
            most = std::max(most, (sand.surface().height(x, y) - under) / sand::kUnitsPerCell);
        }
    }
    return most;
}

/// Returns the exact volume of each part of the sand that walls, holes and rims separate over the whole field, by a
/// place in it. On a grid, cells are joined over faces, and the place is the first cell by rows. On a TIN, vertices are
/// joined by edges of ground triangles, and the place is that of the first vertex in the order of LatticePoint.
inline std::map<std::pair<int, int>, std::int64_t> volumesByPart(const sand::Replica& sand) {
    std::vector<std::size_t> up;
    const auto root = [&](std::size_t at) {
        while (up[at] != at) {
            at = up[at] = up[up[at]];
        }
        return at;
    };
    std::map<std::pair<int, int>, std::int64_t> volumes;
    if (sand.rules().tin == 0) {
        const auto grid = std::get<sand::GridData>(sand.surface().data());
        const sand::HeightField& field = grid.field;
        const auto columns = static_cast<std::size_t>(field.columns()), rows = static_cast<std::size_t>(field.rows());
        up.resize(columns * rows);
        std::iota(up.begin(), up.end(), std::size_t{0});
        const auto isWall = [&, rockAndWalls = grid.ground](std::size_t at) {
            return rockAndWalls != nullptr &&
                   rockAndWalls->isWall(static_cast<int>(at % columns), static_cast<int>(at / columns));
        };
        for (std::size_t at = 0; at < up.size(); ++at) {
            for (const auto& [there, beside] : {std::pair{at % columns > 0, at - 1}, {at >= columns, at - columns}}) {
                if (there && !isWall(at) && !isWall(beside)) {
                    const std::size_t a = root(at), b = root(beside);
                    up[std::max(a, b)] = std::min(a, b);
                }
            }
        }
        for (std::size_t at = 0; at < up.size(); ++at) {
            if (!isWall(at)) {
                const std::size_t first = root(at);
                volumes[{static_cast<int>(first % columns), static_cast<int>(first / columns)}] +=
                    field.height(static_cast<int>(at % columns), static_cast<int>(at / columns));
            }
        }
        return volumes;
    }
    const auto& layer = dynamic_cast<const sand::tin::TinSurface&>(sand.surface()).layer();
    const sand::tin::Triangles& mesh = layer.triangles();
    up.resize(mesh.places.size());
    std::iota(up.begin(), up.end(), std::size_t{0});
    for (const sand::tin::Triangle& triangle : mesh.triangles) {
        for (std::size_t k = 0; triangle.isGround() && k < 3; ++k) {
            const std::size_t a = root(sand::tin::index(triangle.corner[k]));
            const std::size_t b = root(sand::tin::index(triangle.corner[(k + 1) % 3]));
            up[std::max(a, b)] = std::min(a, b);
        }
    }
    std::map<std::size_t, std::pair<sand::tin::LatticePoint, std::int64_t>> parts;
    for (std::size_t at = 0; at < up.size(); ++at) {
        if (mesh.alive(static_cast<sand::tin::Vertex>(at)) && layer.stars()[at] > 0) {
            const auto [part, fresh] = parts.try_emplace(root(at), mesh.places[at], 0);
            part->second.first = std::min(part->second.first, mesh.places[at]);
            part->second.second += layer.volumes()[at];
        }
    }
    for (const auto& [first, part] : parts) {
        volumes[{part.first.x, part.first.y}] += part.second;
    }
    return volumes;
}

/// Returns the volume that has passed from one part to another [cell³]: half the sum of all changes. With an open rim,
/// the outflow counts too.
inline double exchanged(const sand::Replica& before, const sand::Replica& after) {
    const auto one = volumesByPart(before), other = volumesByPart(after);
    const double unit = before.rules().tin == 0 ? sand::kUnitsPerCell
                                                : 6.0 * sand::kUnitsPerCell * sand::kProbePerCell * sand::kProbePerCell;
    std::map<std::pair<int, int>, std::int64_t> all = one;
    for (const auto& [place, volume] : other) {
        all[place] -= volume;
    }
    double sum = 0;
    for (const auto& [place, volume] : all) {
        sum += std::abs(static_cast<double>(volume));
    }
    return sum / 2 / unit;
}

/// Steepness of the surface of a TIN, in taluses: the largest, and the share of the ground that is more than 2 % too
/// steep. Counts only places for which `counts(x, y)` is true.
struct Steepness {
    double largest = 0, tooSteep = 0;
};
template <class Counts>
Steepness steepnessOf(const sand::Replica& sand, double talus, const Counts& counts) {
    Steepness result;
    double all = 0;
    const auto& layer = dynamic_cast<const sand::tin::TinSurface&>(sand.surface()).layer();
    const sand::tin::Triangles& mesh = layer.triangles();
    for (const sand::tin::Triangle& triangle : mesh.triangles) {
        if (!triangle.isGround()) {
            continue;
        }
        std::array<double, 3> x{}, y{}, z{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t corner = sand::tin::index(triangle.corner[k]);
            x[k] = mesh.places[corner].x / 256.0;
            y[k] = mesh.places[corner].y / 256.0;
            z[k] = layer.heights()[corner] / sand::kUnitsPerCell;
        }
        if (!counts((x[0] + x[1] + x[2]) / 3, (y[0] + y[1] + y[2]) / 3)) {
            continue;
        }
        const double x1 = x[1] - x[0], x2 = x[2] - x[0], y1 = y[1] - y[0], y2 = y[2] - y[0];
        const double area = x1 * y2 - x2 * y1;
        const double steep =
            std::hypot((z[1] - z[0]) * y2 - (z[2] - z[0]) * y1, (z[2] - z[0]) * x1 - (z[1] - z[0]) * x2) / area / talus;
        result.largest = std::max(result.largest, steep);
        result.tooSteep += steep > 1.02 ? area : 0;
        all += area;
    }
    result.tooSteep /= all;
    return result;
}

}  // namespace borders
