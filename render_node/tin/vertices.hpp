// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/index_set.hpp"
#include "render_node/surface/box_bins.hpp"
#include "render_node/tin/chunks.hpp"
#include "sand/model/surface_data.hpp"
#include "sand/tin/geometry/surface_view.hpp"
#include "shapes/grid/vertices.hpp"
#include "shapes/model/box.hpp"
#include "shapes/model/sand_rim.hpp"
#include "shapes/tin/geometry.hpp"
#include "shapes/tin/light.hpp"

namespace render_node {

/// Sorts numbers and removes duplicates.
template <class Number>
void sortOnce(std::vector<Number>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

/// Drawn surface of a TIN, on the CPU: vertices with their light, triangles by slot, and lists of changes.
///
/// It depends only on the TIN at the start and on the TIN now, not on the TINs between them. Not thread-safe.
class TinVertices {
public:
    TinVertices(const sand::tin::SurfaceView& tin, double cellSize /* [scene unit] */)
        : TinVertices(tin, cellSize, TinChunks::sideFor(tin.triangles)) {}

    /// Changes by one update.
    struct Change {
        bool whole = false;                       // everything has changed
        bool rim = false;                         // the edge of the sand has changed
        std::vector<sand::tin::Vertex> vertices;  // changed vertices, in ascending order
        std::vector<shapes::Box> boxes;           // around everything that looks different, before and after
    };
    [[nodiscard]] Change update(const sand::tin::SurfaceView& tin, const sand::TinChange& sandChange);
    /// Replaces the whole surface, as an update of everything would.
    [[nodiscard]] Change replaceWhole(const sand::tin::SurfaceView& tin);
    /// Returns a box around everything that an update with `sandChange` may change, before and after. Returns nullopt
    /// if the rim may change, and always if the field has holes. Uses the current state of this surface and of `tin`.
    ///
    /// The boxes of all changes of the sand since the last update together bound the result of one update with all of
    /// them.
    [[nodiscard]] std::optional<shapes::Box> reachOf(const sand::tin::SurfaceView& tin,
                                                     const sand::TinChange& sandChange);

    [[nodiscard]] const std::vector<shapes::TinVertex>& vertices() const { return geometry_.vertices; }
    [[nodiscard]] const std::vector<shapes::TinTriangle>& triangles() const { return geometry_.triangles; }  // by slot
    [[nodiscard]] std::vector<TinChunk>& chunks() { return chunks_.all(); }
    /// Sorts the triangles of a chunk by part and by corners. Returns whether they differ from those at the last call.
    /// The order matters because it is visible where wires cross at a ridge.
    [[nodiscard]] bool settle(TinChunk& chunk) { return chunks_.settle(geometry_, chunk); }
    /// Returns the parts of a sorted chunk that have triangles.
    [[nodiscard]] const std::vector<TinChunk::Part>& partsOf(TinChunk& chunk) const {
        return chunks_.partsOf(geometry_, chunk);
    }
    /// Returns the box around a chunk that has triangles.
    [[nodiscard]] const shapes::Box& boxOf(TinChunk& chunk) const { return TinChunks::boxOf(geometry_, chunk); }
    /// Returns the lowest and the highest height that any vertex of ground has ever had.
    [[nodiscard]] shapes::HeightRange heightsEver() const { return ever_; }
    [[nodiscard]] shapes::SandRim rim() const;

private:
    using Vertex = sand::tin::Vertex;
    static constexpr int kCell = sand::tin::kLatticePerCell;
    TinVertices(const sand::tin::SurfaceView& tin, double cellSize, double chunkSide);
    void grow(const sand::tin::Triangles& mesh);
    [[nodiscard]] bool move(const sand::tin::SurfaceView& tin, std::span<const Vertex> vertices);
    /// Adds the cut edges of the triangle in a slot, or removes them. Returns whether it has any.
    bool keepCuts(std::int32_t slot, bool present);
    void widen(const sand::tin::SurfaceView& tin, Vertex vertex);
    [[nodiscard]] std::vector<Vertex> relight(const sand::tin::SurfaceView& tin);
    void addBoxes(const std::vector<std::int32_t>& slots);

    std::int32_t width_, depth_;  // [probe unit]
    shapes::TinGeometry geometry_;
    TinChunks chunks_;
    shapes::TinLight light_;
    BoxBins changedBoxes_;
    shapes::HeightRange ever_{};
    bool hasHoles_;  // never changes
    // Edges at which the sand is cut: slot and opposite corner, with a square of the field in which the edge was made.
    std::map<std::pair<std::int32_t, std::size_t>, std::int32_t> cuts_;
    std::vector<std::int32_t> cutsAt_;   // by vertex: number of its cut edges
    std::vector<Vertex> elsewhere_;      // scratch: vertices that have moved to another place
    base::IndexList reshaped_, shaded_;  // scratch: triangles
};

}  // namespace render_node
