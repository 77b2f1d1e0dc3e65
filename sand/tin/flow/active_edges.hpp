// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "base/index_set.hpp"
#include "sand/model/rules.hpp"
#include "sand/tin/flow/active_mesh.hpp"
#include "sand/tin/flow/weights.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// The edges over which sand may flow.
///
/// The heights of its corners decide whether a triangle slides, and sand flows only over the edges of sliding
/// triangles. After a sweep, all triangles around each vertex at which sand flowed are watched. Every triangle that
/// can slide in the next sweep is among them. The edges of a triangle are added only once it slides.
///
/// Further triangles and edges never change a result, because no sand flows there. They are therefore forgotten only
/// now and then.
///
/// On an open rim, each sweep lets all sand above height 0 fall over the rim. Sand comes there over watched edges; for
/// any other sand on the rim, wake() is called. Not thread-safe.
class ActiveEdges {
public:
    using Underside = std::function<std::int32_t(LatticePoint)>;

    explicit ActiveEdges(Rim rim = Rim::closed) : rim_(rim) {}

    void reserve(std::size_t vertices) { makeRoom(vertices, 2 * vertices); }
    /// Returns the vertices at which the underside of the obstacle has changed or is gone, because sand may flow there
    /// again. Sand below an unchanged underside has come to rest.
    [[nodiscard]] std::vector<Vertex> takeReleased(const Underside* held);
    /// Begins a run of sweeps with the layer's current sand and without momentum. The layer's moving sand counts as
    /// sand that flowed in the sweep before. `held` is the underside of an obstacle, or null. `band` is true if sand at
    /// rest needs a steeper slope to start than sliding sand needs to continue.
    void begin(const VertexSand& layer, bool band, const Underside* held);
    /// Watches every triangle that may slide in the next sweep because of these vertices. Those are the triangles
    /// around them that are steep enough, and all triangles around a vertex from which sand falls over an open rim.
    /// Call it right after begin().
    void wake(const VertexSand& layer, const Slopes& slopes, std::span<const Vertex> vertices);
    /// Runs one sweep, and then watches all triangles that it may have set in motion. `momentum` is the share of the
    /// last sweep's sliding that continues, 0 to 1. Returns whether a volume changed.
    bool sweep(const VertexSand& layer, const Slopes& slopes, Weights& weights, double momentum);
    /// Returns the volume that has fallen over an open rim since the last call [volume unit].
    [[nodiscard]] std::int64_t takeOutflow() { return std::exchange(outflow_, 0); }
    /// Writes the sand to the layer. Adds the vertices whose volume has changed to `moved`.
    void store(VertexSand& layer, std::vector<Vertex>& moved) const;
    /// Writes to the layer which sand moves: that of the vertices at which sand flowed in the last sweep since begin().
    /// Adds the vertices at which this has changed to `changed`.
    void storeMotion(VertexSand& layer, std::vector<Vertex>& changed);
    /// Returns whether sweeps have visited so many vertices at rest that forgetting them would have cost less.
    [[nodiscard]] bool manyRest() const;
    /// Forgets all triangles that the last sweep cannot have set in motion. Call store() first.
    void forgetResting();
    /// Forgets what `change` of the mesh has made invalid. Returns the corners of the triangles that it forgets. Some
    /// of these vertices may no longer exist.
    [[nodiscard]] std::vector<Vertex> meshChanged(const Mesh::Change& change);
    void clear();

    [[nodiscard]] bool empty() const { return sand_.facetCount() == 0; }
    [[nodiscard]] std::size_t size() const { return sand_.edgeCount(); }

private:
    static constexpr std::size_t kAhead = 8;  // distance from a prefetch to its use [vertex]

    /// A vertex that is or was watched below an obstacle.
    struct Held {
        Vertex vertex;
        LatticePoint place;
        std::int32_t underside;
    };

    void fetch(const Triangles& mesh, Vertex vertex) const;
    void fetchBeside(const Triangles& mesh, Vertex vertex) const;
    [[nodiscard]] bool isHeld(const Triangle& triangle);  // the undersides of its corners must be known
    [[nodiscard]] bool maySlide(const VertexSand& layer, const Slopes& slopes, std::int32_t slot);
    /// Watches all triangles around a vertex.
    void watch(const VertexSand& layer, const Slopes& slopes, Vertex vertex);
    void watchEdges(const VertexSand& layer, const Slopes& slopes, Weights& weights, std::int32_t slot);
    void makeRoom(std::size_t vertices, std::size_t slots);
    [[nodiscard]] std::int32_t facetAt(const VertexSand& layer, const Slopes& slopes, std::int32_t slot);
    [[nodiscard]] std::int32_t localOf(const VertexSand& layer, Vertex vertex);
    [[nodiscard]] double undersideAt(Vertex vertex, const LatticePoint& place);
    [[nodiscard]] bool spills(const Triangles& mesh, Vertex vertex) const {
        return rim_ == Rim::open && isOnRim(mesh, mesh.places[static_cast<std::size_t>(vertex)]);
    }
    void keep(const ActiveMesh::Marks& kept);

    /// All numbers that waking and watching need of a vertex or of a slot. They are in one struct because they are in
    /// no cache where sand begins to move.
    struct VertexNote {
        std::int32_t local = kNoNumber;
        std::uint32_t woken = 0;           // turn in which wake() last examined it
        std::uint32_t undersideKnown = 0;  // turn for which `underside` is known
        bool isHeldBack = false;
        double underside = 0;  // [unit]
    };
    struct SlotNote {
        std::int32_t facet = kNoNumber;
        std::uint32_t examined = 0;  // turn in which wake() last examined it
        std::uint8_t watched = 0;    // one bit per side whose edge is watched
    };
    /// The bits of one edge in `watched` of its two slots.
    struct Bits {
        std::uint8_t left, right;
    };
    [[nodiscard]] VertexNote& noteOf(Vertex vertex) { return ofVertices_[static_cast<std::size_t>(vertex)]; }
    [[nodiscard]] SlotNote& noteOfSlot(std::int32_t slot) { return ofSlots_[static_cast<std::size_t>(slot)]; }

    Rim rim_;
    ActiveMesh sand_;                  // with local numbers
    std::vector<Vertex> vertices_;     // by local vertex
    std::vector<std::int32_t> slots_;  // by local facet
    std::vector<Bits> bits_;           // by local edge
    std::vector<VertexNote> ofVertices_;
    std::vector<SlotNote> ofSlots_;
    std::vector<Held> heldBack_;
    std::vector<Vertex> moving_;                         // all vertices whose sand moves in the layer, and more
    std::vector<std::int32_t> met_, steepHeld_, steep_;  // scratch
    std::uint32_t turn_ = 0;                             // number of begin() calls; marks what wake() has examined
    std::int64_t restingVisits_ = 0;  // vertices at rest, summed over the sweeps, less the usual number at rest
    std::int64_t restAround_ = 0;     // vertices at rest that the last forgetResting() since begin() left
    std::int64_t outflow_ = 0;        // since takeOutflow()
    bool band_ = false;
    bool swept_ = false;  // whether a sweep ran since begin()
    const Underside* held_ = nullptr;
};

}  // namespace sand::tin
