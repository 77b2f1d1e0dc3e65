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

/// A vertex of a TIN as the shader takes it.
struct TinVertex {
    float height = 0;                              // [scene unit]
    std::int32_t x = -1, y = -1;                   // [probe unit]; −1 where no vertex lives
    std::int16_t normalEast = 0, normalNorth = 0;  // 1/32767, of the mean of the triangles around, by their areas
    std::uint16_t open = 0;                        // share of the sky that the vertex sees, 1/65535, in 255 steps
    std::uint16_t mottling = 0;                    // slow change of shade from place to place, 1/65535
};
static_assert(sizeof(TinVertex) == 20);

/// A triangle of a TIN as it is drawn: its corners counter-clockwise from the smallest number on, so that all replicas
/// compute it alike, whichever slots and corners their meshes have.
struct TinTriangle {
    std::array<sand::tin::Vertex, 3> corner{sand::tin::kNobody, sand::tin::kNobody, sand::tin::kNobody};
    std::array<bool, 3> marked{};  // whether the edge across is a constraint, and none of the field's rim
    [[nodiscard]] bool alive() const { return corner[0] != sand::tin::kNobody; }
    friend bool operator==(const TinTriangle&, const TinTriangle&) = default;
};

/// Triangles that lie close together, for leaving out what a camera does not see: they are sent to GL together.
struct TinChunk {
    /// And of those closer together, for a picture that is drawn anew in a small part: a run of `slots`.
    struct Part {
        std::size_t first, end;
        Box box;
    };
    std::vector<std::int32_t> slots;  // of its triangles
    bool changed = false;             // others are in `slots`, or they are not in order: TinSurface::settle()
    bool reshaped = false;            // since the box was measured
    bool partsReshaped = true;        // since the parts were
    Box box;
    std::vector<Part> parts;  // once somebody asks: TinSurface::partsOf()
};

/// Puts numbers in order, each once.
template <class Number>
void sortOnce(std::vector<Number>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

/// The drawn surface of a TIN, on the CPU: vertices with their light, triangles by slot, and what of them changes.
///
/// All of it is a function of the TIN that it began with and the TIN now, whatever came between. Not thread-safe.
class TinSurface {
public:
    TinSurface(const sand::tin::SurfaceView& tin, double cellSize /* [scene unit] */)
        : TinSurface(tin, cellSize, chunkSideFor(tin.triangles)) {}

    /// What an update changed.
    struct Change {
        bool whole = false;                       // everything is another
        bool rim = false;                         // so is where the sand is cut
        std::vector<sand::tin::Vertex> vertices;  // that are others, ascending
        std::vector<Box> boxes;                   // around what looks different, before and after
    };
    [[nodiscard]] Change update(const sand::tin::SurfaceView& tin, const sand::TinChange& damage);
    /// As an update of everything.
    [[nodiscard]] Change replaceWhole(const sand::tin::SurfaceView& tin);
    /// The boxes of all damages since the last update together bound what an update with all of them may change, before
    /// and after; nothing where it may be the rim. From what this surface is now and what the TIN is.
    [[nodiscard]] std::optional<Box> reachOf(const sand::tin::SurfaceView& tin, const sand::TinChange& damage);

    [[nodiscard]] const std::vector<TinVertex>& vertices() const { return vertices_; }
    [[nodiscard]] const std::vector<TinTriangle>& triangles() const { return triangles_; }  // by slot
    [[nodiscard]] std::vector<TinChunk>& chunks() { return chunks_; }
    /// Puts the triangles of a chunk in order, by parts and by their corners; says whether they are others than when
    /// this was called last. Where wires cross at a ridge, the order in which they are drawn shows.
    [[nodiscard]] bool settle(TinChunk& chunk);
    /// The parts of a chunk in order that have triangles.
    [[nodiscard]] const std::vector<TinChunk::Part>& partsOf(TinChunk& chunk) const;
    /// The box around a chunk that has triangles.
    [[nodiscard]] const Box& boxOf(TinChunk& chunk) const;
    /// The lowest and the highest that any vertex has been.
    [[nodiscard]] HeightRange heightsEver() const { return ever_; }
    [[nodiscard]] SandRim rim() const;

private:
    using Vertex = sand::tin::Vertex;
    static constexpr int kCell = sand::tin::kLatticePerCell;
    static constexpr int kPartsAcross = 4;  // a chunk
    struct InChunk {
        int chunk = -1, part = 0, at = 0;
    };
    TinSurface(const sand::tin::SurfaceView& tin, double cellSize, double chunkSide);
    [[nodiscard]] static double chunkSideFor(const sand::tin::Triangles& mesh);
    [[nodiscard]] static TinTriangle drawnOf(const sand::tin::Triangle& triangle);
    void grow(const sand::tin::Triangles& mesh);
    [[nodiscard]] TinVertex placed(const sand::tin::SurfaceView& tin, Vertex vertex) const;
    [[nodiscard]] std::vector<Vertex> moved(const sand::tin::SurfaceView& tin, std::span<const Vertex> asked) const;
    [[nodiscard]] bool move(const sand::tin::SurfaceView& tin, std::span<const Vertex> vertices);
    void standElsewhere(Vertex vertex, const TinVertex& before);
    [[nodiscard]] bool keepRim(Vertex vertex, bool present);
    void replace(std::int32_t slot, const TinTriangle& triangle);
    void leaveChunk(std::int32_t slot);
    /// The chunk, and the part of it, in which a triangle's middle lies.
    [[nodiscard]] InChunk homeOf(const TinTriangle& triangle) const;
    void keepHome(std::int32_t slot);
    [[nodiscard]] glm::dvec3 at(Vertex vertex) const;
    [[nodiscard]] Box boxOf(const TinTriangle& triangle) const;
    /// That of a grid of the same cells, linear between their middles.
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
    BoxBins damaged_;
    HeightRange ever_{};
    std::array<std::map<std::int32_t, Vertex>, 4> rim_;  // south, east, north, west, by place along the side
    std::vector<Vertex> elsewhere_;                      // scratch: who stands at another place than before
    base::IndexList reshaped_, lit_, shaded_;            // scratch: triangles, vertices, triangles
};

}  // namespace render_node
