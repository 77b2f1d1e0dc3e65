// SPDX-License-Identifier: Apache-2.0
#include "scene/load/tin_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "sand/tin/refine/start_maker.hpp"
#include "scene/load/tin_settings.hpp"

namespace scene {
namespace {

constexpr int kUsualSide = 512;  // default number of nominal cells along the longer side of points

/// Throws base::InputError unless volumes of heights up to `highest` [unit] fit over this field.
void requireRange(const host::TomlTable& file, double highest, int columns, int rows, double unit) {
    const double most = sand::tin::mostHeight(columns, rows);
    if (highest > most) {
        file.fail("tin", fmt::format("heights of up to {} on {} x {} cells are more than a TIN's volumes can hold, {} "
                                     "is the most; set 'datum', or fewer cells",
                                     highest * unit, columns, rows, most * unit));
    }
}

bool hasRock(const sand::Ground& ground) {
    const sand::CellArray& cells = ground.cells();
    for (int row = 0; row < cells.rows(); ++row) {
        const bool rock = std::any_of(cells.row(row), cells.row(row) + cells.columns(), [](std::int32_t bed) {
            return bed != sand::Ground::kBottomless && bed != sand::Ground::kWall;
        });
        if (rock) {
            return true;
        }
    }
    return false;
}

/// Returns the number of places on the lattice: those of the points, and the corners of their field, which the TIN
/// adds.
std::size_t distinctPlaces(const sand::tin::TinStart& start) {
    std::vector<sand::tin::LatticePoint> places = start.places;
    places.insert(places.end(), {{0, 0}, {start.width, 0}, {start.width, start.depth}, {0, start.depth}});
    std::sort(places.begin(), places.end());
    return static_cast<std::size_t>(std::unique(places.begin(), places.end()) - places.begin());
}

/// Makes the TIN of points that are already on the lattice.
sand::tin::TinStart joined(const host::TomlTable& file, const host::TomlTable& tin, const Scene& scene,
                           const Progress& done) {
    sand::tin::TinStart start = *scene.tin;
    const std::size_t places = distinctPlaces(start);
    if (places > std::size_t{sand::tin::kMostPlaces}) {
        file.requiredTable("terrain").fail(
            "file", fmt::format("{} vertices with the field's corners are more than a TIN can have, {} are the most; "
                                "thin out the points",
                                places, sand::tin::kMostPlaces));
    }
    (void)tin.numberOr("cell", 1);  // already read by layOutPoints()
    start.settings = readTinSettings(tin, {scene.rules.columns, scene.rules.rows, scene.terrain.cellSize()}, places);
    tin.finish();
    start = sand::tin::join(start, scene.rules.rim, done);
    const std::size_t most = tin.has("vertices") ? static_cast<std::size_t>(start.settings.mostVertices)
                                                 : std::size_t{sand::tin::kMostPlaces};
    if (start.places.size() > most) {
        tin.fail("vertices", fmt::format("the points are {} vertices, the open rim takes {} more, and {} are the most; "
                                         "raise it, set a larger 'widest', or thin out the points",
                                         places, start.places.size() - places, most));
    }
    keepUsual(tin, start);
    return start;
}

/// Makes a TIN of the scene's height field.
sand::tin::TinStart followed(const host::TomlTable& tin, Scene& scene, const Progress& done) {
    const sand::HeightField& field = scene.terrain;
    const sand::tin::Settings settings = readTinSettings(tin, {field.columns(), field.rows(), field.cellSize()});
    tin.finish();
    try {
        sand::tin::Followed made = sand::tin::follow(field, scene.ground.get(), settings, scene.rules.rim, done);
        if (made.maxError > settings.maxError) {
            const double asked = tin.has("max_error") ? tin.number("max_error") : settings.maxError * field.unit();
            scene.warnings.push_back(fmt::format(
                "{} vertices are too few for max_error = {:.6g}: some cell lies {:.4g} above or below the TIN; raise "
                "'vertices' or 'max_error' in [tin]",
                made.start.places.size(), asked, made.maxError * field.unit()));
        }
        keepUsual(tin, made.start);
        return std::move(made.start);
    } catch (const std::length_error& error) {
        tin.fail("vertices", error.what());
    }
}

/// Puts points on the lattice. Returns the largest distance of a point from the datum [unit], which may be larger than
/// a height can be.
double putOnLattice(const Points& points, const Georeference& origin, const sand::HeightField& cell,
                    sand::tin::TinStart& start) {
    const auto lattice = [&](double length, std::int32_t most) {
        return std::min(static_cast<std::int32_t>(std::floor(length / cell.cellSize() * sand::kProbePerCell + 0.5)),
                        most);
    };
    double highest = 0;
    for (const auto& [x, y, z] : points) {
        const double units = std::floor((z - origin.datum) / cell.unit() + 0.5);
        highest = std::max(highest, std::abs(units));
        start.places.push_back({lattice(x - origin.west, start.width), lattice(y - origin.south, start.depth)});
        start.heights.push_back(
            static_cast<std::int32_t>(std::clamp(units, double{-sand::kMaxHeight}, double{sand::kMaxHeight})));
    }
    return highest;
}

/// Warns of points that share a place of the lattice. The TIN takes the first of them in the file.
void warnOfNearPoints(const std::string& file, const Points& points, const std::vector<sand::tin::LatticePoint>& places,
                      double step, Scene& scene) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return std::tie(places[a], a) < std::tie(places[b], b); });
    std::size_t near = 0;
    double most = 0;
    for (std::size_t i = 1, taken = 0; i < order.size(); ++i) {
        if (places[order[i]] != places[order[taken]]) {
            taken = i;
            continue;
        }
        ++near;
        most = std::max(most, std::abs(points[order[i]][2] - points[order[taken]][2]));
    }
    if (near > 0) {
        scene.warnings.push_back(fmt::format(
            "{}: {} points lie within {:.3g} of another, which a TIN of such cells cannot separate; the first in the "
            "file was taken, others were up to {:.3g} higher or lower; set a smaller cell in [tin]",
            file, near, step, most));
    }
}

}  // namespace

sand::HeightField layOutPoints(const host::TomlTable& file, const host::TomlTable& terrain, const Points& points,
                               Scene& scene) {
    double west = points[0][0], south = points[0][1], east = west, north = south;
    for (const auto& [x, y, z] : points) {
        west = std::min(west, x);
        east = std::max(east, x);
        south = std::min(south, y);
        north = std::max(north, y);
    }
    const double longer = std::max(east - west, north - south);
    if (!std::isnormal(longer * longer)) {
        terrain.fail("file", fmt::format("the points are {} long, which cannot be a length of terrain", longer));
    }
    const double cell =
        file.requiredTable("tin").numberOr("cell", longer / kUsualSide, {longer / sand::kMaxSide, longer});
    const auto cellsOf = [cell](double side) {
        return std::clamp(static_cast<int>(std::ceil(side / cell)), 1, sand::kMaxSide);
    };
    scene.rules.columns = cellsOf(east - west);
    scene.rules.rows = cellsOf(north - south);
    sand::HeightField one(1, 1, cell);
    scene.georeference.west = west;
    scene.georeference.south = south;
    scene.georeference.datum = terrain.numberOr("datum", 0);
    auto start = std::make_shared<sand::tin::TinStart>();
    start->width = scene.rules.columns * sand::kProbePerCell;
    start->depth = scene.rules.rows * sand::kProbePerCell;
    const double highest = putOnLattice(points, scene.georeference, one, *start);
    if (highest > sand::kMaxHeight) {
        terrain.fail("file",
                     fmt::format("a height of {:.6g} from 'datum' is beyond the range of ±{} (4096 cells); set 'datum'",
                                 highest * one.unit(), sand::kMaxHeight * one.unit()));
    }
    requireRange(file, highest, scene.rules.columns, scene.rules.rows, one.unit());
    warnOfNearPoints((terrain.folder() / terrain.text("file")).string(), points, start->places, sand::probeUnit(cell),
                     scene);
    scene.tin = start;
    return one;
}

void readTin(const host::TomlTable& file, Scene& scene, const Progress& done) {
    const auto tin = file.table("tin");
    if (!tin) {
        return;
    }
    if (scene.ground != nullptr && hasRock(*scene.ground)) {
        file.fail("tin", "a TIN has no rock; leave out [tin], or 'layer' and 'bedrock'");
    }
    if (scene.tin != nullptr) {
        scene.beginAs(joined(file, *tin, scene, done));
        return;
    }
    const sand::HeightField& field = scene.terrain;
    std::int32_t highest = 0;
    for (int row = 0; row < field.rows(); ++row) {
        for (int column = 0; column < field.columns(); ++column) {
            highest = std::max(highest, std::abs(field.height(column, row)));
        }
    }
    requireRange(file, highest, field.columns(), field.rows(), field.unit());
    sand::tin::TinStart start = followed(*tin, scene, done);
    scene.ground = nullptr;  // the ground's walls are holes of the TIN
    scene.rules.ground = 0;
    scene.beginAs(std::move(start));
}

}  // namespace scene
