// SPDX-License-Identifier: Apache-2.0
// Measures a TIN that approximates a raster: its error by vertices and by run time, beside a regular grid with as many
// points.
#include "sand/tin/refine/simplify.hpp"

#include <cmath>
#include <limits>

#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "sand/grid/dunes.hpp"
#include "scene/import/esri_file.hpp"

namespace bench {
namespace {

constexpr std::int32_t kCell = sand::kProbePerCell;

struct Terrain {
    std::string name;
    int columns = 0, rows = 0;
    std::int32_t cellDepth = kCell;  // [probe unit]
    std::vector<double> heights;     // row by row from the south

    [[nodiscard]] std::int32_t width() const { return columns * kCell; }
    [[nodiscard]] std::int32_t depth() const { return rows * cellDepth; }
    [[nodiscard]] sand::tin::Raster raster() const {
        return {heights, columns, rows, {kCell / 2, cellDepth / 2}, {kCell, cellDepth}};
    }
};

Terrain dunesOf(int side, std::uint32_t seed) {
    sand::HeightField field(side, side, 1.0);
    sand::grid::makeDunes({.height = 6, .length = 60, .seed = seed}, field);
    Terrain terrain{"dunes", side, side, kCell, {}};
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            terrain.heights.push_back(field.height(x, y) * field.unit());
        }
    }
    return terrain;
}

Terrain terrainOf(const scene::EsriGrid& grid) {
    Terrain terrain{"file", grid.columns, grid.rows, static_cast<std::int32_t>(std::lround(kCell * grid.aspect())), {}};
    for (int y = 0; y < grid.rows; ++y) {
        for (int x = 0; x < grid.columns; ++x) {
            terrain.heights.push_back(grid.at(x, y));
        }
    }
    return terrain;
}

/// Returns a regular grid with about `share` of the samples. It has the outermost samples, and leaves out samples
/// without data.
sand::tin::Simplified regularGrid(const Terrain& terrain, double share) {
    const int most = static_cast<int>(share * terrain.columns * terrain.rows);
    const double aspect = static_cast<double>(terrain.width()) / terrain.depth();
    const int columns = std::clamp(static_cast<int>(std::sqrt(most * aspect)), 2, terrain.columns);
    const int rows = std::clamp(most / columns, 2, terrain.rows);
    std::vector<sand::tin::LatticePoint> places;
    std::vector<double> heights;
    const auto sampleOf = [](int i, int count, int samples) {
        return static_cast<std::size_t>((i * (samples - 1) + (count - 1) / 2) / (count - 1));
    };
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const std::size_t sample = sampleOf(row, rows, terrain.rows) * static_cast<std::size_t>(terrain.columns) +
                                       sampleOf(column, columns, terrain.columns);
            if (!std::isnan(terrain.heights[sample])) {
                places.push_back(terrain.raster().placeOf(sample));
                heights.push_back(terrain.heights[sample]);
            }
        }
    }
    return sand::tin::measured(terrain.width(), terrain.depth(), terrain.raster(), places, heights);
}

void measure(const Terrain& terrain, int runs, Csv& csv) {
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    std::int64_t samples = 0;
    for (const double height : terrain.heights) {
        if (!std::isnan(height)) {
            lowest = std::min(lowest, height);
            highest = std::max(highest, height);
            ++samples;
        }
    }
    for (const double share : {0.0025, 0.005, 0.01, 0.02, 0.05, 0.1}) {
        const int vertices = std::max(static_cast<int>(share * static_cast<double>(samples)), 8);
        progress("{} of {} x {} samples, {} vertices", terrain.name, terrain.columns, terrain.rows, vertices);
        std::vector<double> seconds;
        seconds.reserve(static_cast<std::size_t>(runs));
        sand::tin::Simplified tin;
        while (seconds.empty() || static_cast<int>(seconds.size()) < runsFor(seconds.front(), runs)) {
            seconds.push_back(secondsOf([&] {
                tin = sand::tin::simplify(terrain.width(), terrain.depth(), terrain.raster(), {0, vertices});
            }));
        }
        const sand::tin::Simplified grid =
            regularGrid(terrain, static_cast<double>(vertices) / static_cast<double>(samples));
        const Spread spread = spreadOf(seconds);
        csv.row(terrain.name, terrain.columns, terrain.rows, samples, highest - lowest, tin.places.size(), share,
                seconds.size(), 1e3 * spread.median, 1e3 * spread.lowest, 1e3 * spread.highest, tin.maxError,
                tin.rmsError, grid.places.size(), grid.maxError, grid.rmsError);
    }
}

}  // namespace

void simplify(const Settings& settings, Csv& csv) {
    std::vector<Terrain> terrains;
    if (!settings.raster.empty()) {
        terrains.push_back(terrainOf(scene::withoutEmptyEdges(scene::readEsriGrid(settings.raster))));
    } else {
        for (const int side : settings.sizes) {
            terrains.push_back(dunesOf(side, settings.seed));
        }
    }
    csv.note("greedy insertion until there are so many vertices: a share of the samples that have data");
    csv.note("max, rms: vertical errors over all samples, in the raster's unit of height, as relief is (dunes: cells)");
    csv.note("grid_: vertices and errors of a regular grid of as many samples, triangulated; CPU time of one thread");
    csv.columns(
        "terrain,columns,rows,samples,relief,vertices,share,runs,ms_median,ms_min,ms_max,max,rms,grid_vertices,grid_"
        "max,"
        "grid_"
        "rms");
    for (const Terrain& terrain : terrains) {
        measure(terrain, settings.runs, csv);
    }
}

}  // namespace bench
