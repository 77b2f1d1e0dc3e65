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
/// A triangle slides as the heights of its corners have it, and sand flows over the edges of those that slide. Whoever
/// watches the triangles around every vertex that flowed in the last sweep has all that can slide in the next; only
/// when one does are its edges needed. Triangles and edges watched beside these find nothing to do. Hence it does not
/// matter which they are, and they are forgotten only now and then. Over an open rim each sweep lets all fall that lies
/// on the rim above height 0: sand comes there over edges that are watched, or wake() is told of it. Not thread-safe.
class ActiveEdges {
public:
    using Underside = std::function<std::int32_t(Place)>;

    explicit ActiveEdges(Rim rim = Rim::closed) : rim_(rim) {}

    void reserve(std::size_t vertices) { makeRoom(vertices, 2 * vertices); }
    /// Vertices where an obstacle stood and now another one does, or none: sand may flow there again. Where it is as it
    /// was, sand has come to rest under it.
    [[nodiscard]] std::vector<Vertex> takeReleased(const Underside* held);
    /// Takes the layer's sand as it is now, for a run of sweeps under this obstacle, or none; nothing flows yet.
    /// `band`: sand at rest starts to slide later than sliding sand stops.
    void begin(const VertexSand& layer, bool band, const Underside* held);
    /// Watches every triangle that may slide in the next sweep because of these vertices: those around them that are
    /// steep enough, and all around one from which sand falls over an open rim. To be called right after begin().
    void wake(const VertexSand& layer, const Slopes& slopes, std::span<const Vertex> vertices);
    /// One sweep, which then watches all that it may have set in motion; false when nothing flowed. `momentum`: what of
    /// the last sweep's fluxes goes on, 0 to 1.
    bool sweep(const VertexSand& layer, const Slopes& slopes, Weights& weights, double momentum);
    /// Returns the volume that has fallen over an open rim since the last call [volume unit].
    [[nodiscard]] std::int64_t takeOutflow() { return std::exchange(outflow_, 0); }
    /// Gives the layer its sand, and adds who has another volume now to `moved`.
    void store(VertexSand& layer, std::vector<Vertex>& moved) const;
    /// Whether so much has been swept in vain since it was forgotten last that to forget it would have paid.
    [[nodiscard]] bool manyRest() const;
    /// Forgets what the last sweep cannot have set in motion. The layer must have got its sand.
    void forgetResting();
    /// The mesh is another here: forgets what is no more what it was. Returns the corners of triangles that went, some
    /// of which may be gone.
    [[nodiscard]] std::vector<Vertex> meshChanged(const Mesh::Change& change);
    void clear();

    [[nodiscard]] bool empty() const { return sand_.facetCount() == 0; }
    [[nodiscard]] std::size_t size() const { return sand_.edgeCount(); }

private:
    /// Where an obstacle stands above sand that is, or was, watched.
    struct Held {
        Vertex vertex;
        Place place;
        std::int32_t underside;
    };

    void fetch(const Triangles& mesh, Vertex vertex) const;
    void fetchBeside(const Triangles& mesh, Vertex vertex) const;
    [[nodiscard]] bool isHeld(const Triangle& triangle);  // its corners' undersides are known
    [[nodiscard]] bool maySlide(const VertexSand& layer, const Slopes& slopes, std::int32_t slot);
    /// All triangles around a vertex.
    void watch(const VertexSand& layer, const Slopes& slopes, Vertex vertex);
    void watchEdges(const VertexSand& layer, const Slopes& slopes, Weights& weights, std::int32_t slot);
    void makeRoom(std::size_t vertices, std::size_t slots);
    [[nodiscard]] std::int32_t facetAt(const VertexSand& layer, const Slopes& slopes, std::int32_t slot);
    [[nodiscard]] std::int32_t localOf(const VertexSand& layer, Vertex vertex);
    [[nodiscard]] double undersideAt(Vertex vertex, const Place& place);
    [[nodiscard]] bool spills(const Triangles& mesh, Vertex vertex) const {
        return rim_ == Rim::open && isOnRim(mesh, mesh.places[static_cast<std::size_t>(vertex)]);
    }
    void keep(const ActiveMesh::Marks& kept);

    /// Of a vertex, and of a slot: all that is asked for at once, for where sand begins to move it is in no cache.
    struct VertexNote {
        std::int32_t local = kNobody;
        std::uint32_t woken = 0;           // the turn in which wake() saw it last
        std::uint32_t undersideKnown = 0;  // the turn of begin()
        bool isHeldBack = false;
        double underside = 0;  // then
    };
    struct SlotNote {
        std::int32_t facet = kNobody;
        std::uint32_t examined = 0;  // the turn in which wake() saw it last
        std::uint8_t watched = 0;    // a bit per side whose edge is watched
    };
    /// Of an edge, among `watched` of its two slots.
    struct Bits {
        std::uint8_t left, right;
    };
    [[nodiscard]] VertexNote& noteOf(Vertex vertex) { return ofVertices_[static_cast<std::size_t>(vertex)]; }
    [[nodiscard]] SlotNote& noteOfSlot(std::int32_t slot) { return ofSlots_[static_cast<std::size_t>(slot)]; }

    Rim rim_;
    ActiveMesh sand_;                  // by local numbers
    std::vector<Vertex> vertices_;     // of a local vertex
    std::vector<std::int32_t> slots_;  // of a local facet
    std::vector<Bits> bits_;           // of a local edge
    std::vector<VertexNote> ofVertices_;
    std::vector<SlotNote> ofSlots_;
    std::vector<Held> heldBack_;
    std::vector<std::int32_t> met_, steepHeld_, steep_;  // scratch
    std::uint32_t turn_ = 0;                             // of begin() and of wake()
    std::int64_t inVain_ = 0;      // vertices at rest, sweep by sweep, beside those that always are
    std::int64_t restAround_ = 0;  // of those: how many were left when edges were forgotten, since begin()
    std::int64_t outflow_ = 0;     // since takeOutflow()
    bool band_ = false;
    const Underside* held_ = nullptr;
};

}  // namespace sand::tin
