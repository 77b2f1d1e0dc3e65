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

/// Returns whether a file name is that of points: it ends in .csv or .xyz.
[[nodiscard]] bool holdsPoints(const std::filesystem::path& file);

/// Points or a raster as a TIN of sand on its own lattice, with the scale of its whole numbers.
///
/// The field is the rectangle around the points, except slivers along its sides (slivers.hpp). A corner of the field
/// without a point is as high as the nearest point.
struct TinSand {
    sand::tin::VertexSand layer;
    double step = 1;                                 // step of the lattice [file's length unit]
    HeightScale scale;                               // scale of heights
    std::vector<std::array<double, 3>> points;       // one per vertex, as read, except moved ones [file's unit]
    std::vector<std::int64_t> volumes;               // one per vertex, at the start
    std::int32_t threshold = 0, startThreshold = 0;  // [unit per 256 lattice steps], see Rules
    std::int32_t lowest = 0;  // lowest height at the start [unit], from which volumes are counted
    int cornersAdded = 0;
    int placesMoved = 0;                // by at most half a lattice step, to keep triangles counter-clockwise
    std::vector<std::string> warnings;  // one line each

    /// Returns the volume above the lowest vertex of the start [volume unit]. The choice of the unit makes it fit.
    [[nodiscard]] std::int64_t volume() const;
    /// Returns the size of a volume unit in cubic length units of the file.
    [[nodiscard]] double volumeUnit() const { return scale.unit * step * step / 6; }
    /// Returns the current triangles at the places that were read. Vertices whose sand has not changed keep their
    /// original heights.
    [[nodiscard]] Mesh toMesh() const;
};

/// Points that greedy insertion chooses from a raster, and their distance from all of its cells [raster's unit].
struct Thinned {
    Points points;                                  // middles of cells, including those in its four corners
    double step = 1;                                // step of the lattice on which its cells lie
    double maxError = 0, rmsError = 0;              // vertical distance over all cells with data
    std::shared_ptr<const sand::tin::Holes> holes;  // on that lattice; null if all cells have data
    std::vector<std::pair<sand::tin::Vertex, sand::tin::Vertex>> outline;  // outline of the holes: edges between points
};

/// Chooses the points of a raster until `goal` is met. The heights of a raster that is moved in are freed as early as
/// possible. Throws base::InputError for:
/// - a single row or column, cells more oblong than 1 : 1000, cells without data that are not square,
/// - fewer vertices than the outline of the cells without data has.
[[nodiscard]] Thinned thin(EsriGrid raster, const sand::tin::SimplifyGoal& goal);

/// Makes a TIN of sand. `file` is for messages. The lattice of points has a step of 2^-19 of the longer side, rounded
/// up by at most 1/32. Throws base::InputError for:
/// - more than kMostVertices points, a strip too thin for the lattice, heights that do not fit,
/// - a talus of fewer than kLeastThreshold units.
[[nodiscard]] TinSand toTin(const Points& points, const std::string& file, const TalusSettings& material);
[[nodiscard]] TinSand toTin(const Thinned& thinned, const std::string& file, const TalusSettings& material);

/// Steepness of the triangles of a mesh.
struct Steepness {
    double steepest = 0;      // rise over run
    double tooSteepArea = 0;  // share of the ground that is more than a percent steeper than the talus
};
[[nodiscard]] Steepness steepnessOf(const Mesh& mesh, double talus /* rise over run */);

}  // namespace scene::relax
