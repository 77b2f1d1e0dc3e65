// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "base/index_set.hpp"
#include "render_node/grid/vertices.hpp"
#include "render_node/surface/box_bins.hpp"
#include "render_node/surface/frustum.hpp"
#include "render_node/surface/sand_rim.hpp"
#include "render_node/tin/relief.hpp"
#include "render_node/tin/vertex_squares.hpp"
#include "sand/model/surface_data.hpp"
#include "sand/tin/geometry/surface_view.hpp"

namespace render_node {

/// Vertex of a TIN, as the shader reads it.
struct TinVertex {
    float height = 0;                              // [scene unit]
    std::int32_t x = -1, y = -1;                   // [probe unit]; −1 if no vertex has this number
    std::int16_t normalEast = 0, normalNorth = 0;  // 1/32767, mean normal of the triangles around it, weighted by area
    std::uint16_t open = 0;                        // visible share of the sky, 1/65535, in 255 steps
    std::uint16_t mottling = 0;                    // slow change of shade from place to place, 1/65535
};
static_assert(sizeof(TinVertex) == 20);

/// Triangle of a TIN, as it is drawn. Its corners are counter-clockwise and begin with the smallest number. So all
/// replicas compute it alike, although their meshes may have other slots and begin with other corners.
struct TinTriangle {
    std::array<sand::tin::Vertex, 3> corner{sand::tin::kNoNumber, sand::tin::kNoNumber, sand::tin::kNoNumber};
    std::array<bool, 3> marked{};  // whether the edge opposite the corner is a constraint inside the field
    [[nodiscard]] bool alive() const { return corner[0] != sand::tin::kNoNumber; }
    friend bool operator==(const TinTriangle&, const TinTriangle&) = default;
};

/// Triangles that are close together. They are culled together and sent to GL together.
struct TinChunk {
    /// Triangles of a chunk that are closer together, for drawing a small part of a picture: a run of `slots`.
    struct Part {
        std::size_t first, end;
        Box box;
    };
    std::vector<std::int32_t> slots;  // slots of its triangles
    bool changed = false;             // `slots` has other triangles or is not sorted; see TinVertices::settle()
    bool reshaped = false;            // a triangle has changed its shape since the box was measured
    bool partsReshaped = true;        // a triangle has changed its shape since the parts were measured
    Box box;
    std::vector<Part> parts;  // made by TinVertices::partsOf()
};

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
        : TinVertices(tin, cellSize, chunkSideFor(tin.triangles)) {}

    /// Changes by one update.
    struct Change {
        bool whole = false;                       // everything has changed
        bool rim = false;                         // the edge of the sand has changed
        std::vector<sand::tin::Vertex> vertices;  // changed vertices, in ascending order
        std::vector<Box> boxes;                   // around everything that looks different, before and after
    };
    [[nodiscard]] Change update(const sand::tin::SurfaceView& tin, const sand::TinChange& sandChange);
    /// Replaces the whole surface, as an update of everything would.
    [[nodiscard]] Change replaceWhole(const sand::tin::SurfaceView& tin);
    /// Returns a box around everything that an update with `sandChange` may change, before and after. Returns nullopt
    /// if the rim may change. Uses the current state of this surface and of `tin`.
    ///
    /// The boxes of all changes of the sand since the last update together bound the result of one update with all of
    /// them.
    [[nodiscard]] std::optional<Box> reachOf(const sand::tin::SurfaceView& tin, const sand::TinChange& sandChange);

    [[nodiscard]] const std::vector<TinVertex>& vertices() const { return vertices_; }
    [[nodiscard]] const std::vector<TinTriangle>& triangles() const { return triangles_; }  // by slot
    [[nodiscard]] std::vector<TinChunk>& chunks() { return chunks_; }
    /// Sorts the triangles of a chunk by part and by corners. Returns whether they differ from those at the last call.
    /// The order matters because it is visible where wires cross at a ridge.
    [[nodiscard]] bool settle(TinChunk& chunk);
    /// Returns the parts of a sorted chunk that have triangles.
    [[nodiscard]] const std::vector<TinChunk::Part>& partsOf(TinChunk& chunk) const;
    /// Returns the box around a chunk that has triangles.
    [[nodiscard]] const Box& boxOf(TinChunk& chunk) const;
    /// Returns the lowest and the highest height that any vertex has ever had.
    [[nodiscard]] HeightRange heightsEver() const { return ever_; }
    [[nodiscard]] SandRim rim() const;

private:
    using Vertex = sand::tin::Vertex;
    static constexpr int kCell = sand::tin::kLatticePerCell;
    static constexpr int kPartsAcross = 4;  // parts along a side of a chunk
    struct InChunk {
        int chunk = -1, part = 0, at = 0;
    };
    TinVertices(const sand::tin::SurfaceView& tin, double cellSize, double chunkSide);
    [[nodiscard]] static double chunkSideFor(const sand::tin::Triangles& mesh);
    [[nodiscard]] static TinTriangle drawnOf(const sand::tin::Triangle& triangle);
    void grow(const sand::tin::Triangles& mesh);
    [[nodiscard]] TinVertex placed(const sand::tin::SurfaceView& tin, Vertex vertex) const;
    [[nodiscard]] std::vector<Vertex> moved(const sand::tin::SurfaceView& tin, std::span<const Vertex> asked) const;
    [[nodiscard]] bool move(const sand::tin::SurfaceView& tin, std::span<const Vertex> vertices);
    void moveSquare(Vertex vertex, const TinVertex& before);
    [[nodiscard]] bool keepRim(Vertex vertex, bool present);
    void replace(std::int32_t slot, const TinTriangle& triangle);
    void leaveChunk(std::int32_t slot);
    /// Returns the chunk and the part in which a triangle's middle lies.
    [[nodiscard]] InChunk homeOf(const TinTriangle& triangle) const;
    void keepHome(std::int32_t slot);
    [[nodiscard]] glm::dvec3 at(Vertex vertex) const;
    [[nodiscard]] Box boxOf(const TinTriangle& triangle) const;
    /// Returns the mottling of a grid of the same cells, linear between the cells' middles.
    [[nodiscard]] static std::uint16_t mottlingOf(std::int32_t x, std::int32_t y);
    void addToRelief(const sand::tin::SurfaceView& tin, const TinTriangle& triangle);
    bool lightFrom(const sand::tin::SurfaceView& tin, Vertex vertex);
    bool openTo(const sand::tin::SurfaceView& tin, Vertex vertex);
    void addVerticesAround(const std::vector<sand::CellRect>& cells);
    [[nodiscard]] std::vector<Vertex> relight(const sand::tin::SurfaceView& tin,
                                              const std::vector<std::int32_t>& reshaped);
    [[nodiscard]] TinTriangle& triangle(std::int32_t slot) { return triangles_[static_cast<std::size_t>(slot)]; }
    [[nodiscard]] TinVertex& vertex(Vertex number) { return vertices_[static_cast<std::size_t>(number)]; }

    double cellSize_, unit_, probe_;      // [scene unit]
    std::int32_t width_, depth_;          // [probe unit]
    int across_;                          // chunks
    double chunkSide_;                    // [probe unit]
    std::vector<TinVertex> vertices_;     // by number
    std::vector<TinTriangle> triangles_;  // by slot
    std::vector<InChunk> inChunk_;        // by slot
    std::vector<TinChunk> chunks_;        // row by row from the south-west
    VertexSquares squares_;
    TinRelief relief_;
    BoxBins changedBoxes_;
    HeightRange ever_{};
    std::array<std::map<std::int32_t, Vertex>, 4> rim_;  // south, east, north, west, by place along the side
    std::vector<Vertex> elsewhere_;                      // scratch: vertices that have moved to another place
    base::IndexList reshaped_, lit_, shaded_;            // scratch: triangles, vertices, triangles
};

}  // namespace render_node
