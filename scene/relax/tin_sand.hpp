// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sand/tin/refine/simplify.hpp"
#include "sand/tin/volume/vertex_sand.hpp"
#include "scene/import/esri_grid.hpp"
#include "scene/import/mesh_file.hpp"
#include "scene/import/points_file.hpp"
#include "scene/relax/grid_sand.hpp"
#include "scene/relax/height_scale.hpp"

namespace scene::relax {

inline constexpr int kMostVertices = 1 << 22;

/// Whether a name is one of points: .csv or .xyz.
[[nodiscard]] bool holdsPoints(const std::filesystem::path& file);

/// Points or a raster as a TIN of sand, on a lattice of their own, and what its whole numbers stand for.
///
/// The field is the rectangle around what was read, but for slivers along its sides (slivers.hpp); corners of it that
/// are no point are as high as the nearest one.
struct TinSand {
    sand::tin::VertexSand layer;
    double step = 1;                                 // of the lattice [file's length unit]
    HeightScale scale;                               // of heights
    std::vector<std::array<double, 3>> points;       // by vertex, as they were read but for those moved [file's unit]
    std::vector<std::int64_t> volumes;               // by vertex, at the start
    std::int32_t threshold = 0, startThreshold = 0;  // [unit per 256 lattice steps], as Rules'
    std::int32_t lowest = 0;                         // at the start [unit]: what volumes are counted from
    int cornersAdded = 0;
    int placesMoved = 0;                // by half a lattice step at most, to keep triangles counter-clockwise
    std::vector<std::string> warnings;  // one line each

    /// Over the lowest vertex there was [volume unit]; fits, by the choice of the unit.
    [[nodiscard]] std::int64_t volume() const;
    /// A volume unit in cubic length units of the file.
    [[nodiscard]] double volumeUnit() const { return scale.unit * step * step / 6; }
    /// Its triangles as they are now, at the places that were read; vertices without any change at their heights too.
    [[nodiscard]] Mesh toMesh() const;
};

/// What greedy insertion takes of a raster, and how near that comes to all of it [raster's unit].
struct Thinned {
    Points points;                                  // middles of cells, those in its four corners among them
    double step = 1;                                // of the lattice that its cells lie on
    double maxError = 0, rmsError = 0;              // vertical, over all cells with data
    std::shared_ptr<const sand::tin::Holes> holes;  // on that lattice; null when all have data
    std::vector<std::pair<sand::tin::Vertex, sand::tin::Vertex>> outline;  // of holes, edges between points
};

/// Throws base::InputError for a single row or column, for cells more oblong than 1 : 1000 or without data where they
/// are not square, and for fewer vertices than the outline of those without data has.
[[nodiscard]] Thinned thin(const EsriGrid& raster, const sand::tin::SimplifyGoal& goal);

/// Throws base::InputError: more than kMostVertices, a strip too thin for the lattice, heights that do not fit, a
/// talus of fewer than kLeastThreshold units. `file` is for messages. The lattice of points has a step of 2^-19 of the
/// longer side, rounded up by 1/32 at most.
[[nodiscard]] TinSand toTin(const Points& points, const std::string& file, const TalusSettings& material);
[[nodiscard]] TinSand toTin(const Thinned& thinned, const std::string& file, const TalusSettings& material);

/// How steep the triangles of a mesh are.
struct Steepness {
    double steepest = 0;      // rise over run
    double tooSteepArea = 0;  // share of the ground that is steeper than the talus by more than a percent
};
[[nodiscard]] Steepness steepnessOf(const Mesh& mesh, double talus /* rise over run */);

}  // namespace scene::relax
