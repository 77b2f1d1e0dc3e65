// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sand/tin/layer.hpp"
#include "sand/tin/weights.hpp"

namespace sand::tin {

/// The edges over which sand may flow, side by side in memory with the heights that they read.
///
/// An edge's flux is a function of the heights of four vertices: its ends and the apices of its two triangles. Whoever
/// watches the edges around every vertex that flowed in the last sweep has all that can flow in the next; edges watched
/// beside these find nothing to do. Hence it does not matter which they are, and they are forgotten only now and then.
/// Not thread-safe.
class ActiveEdges {
public:
    using Underside = std::function<std::int32_t(Place)>;

    /// Takes the layer's sand as it is now, for a run of sweeps under this obstacle, or none; nothing flows yet.
    /// `band`: sand at rest starts to slide later than sliding sand stops.
    void begin(const Layer& layer, bool band, const Underside* held);
    /// Watches every edge whose flux depends on this vertex.
    void watch(const Layer& layer, const Slopes& slopes, Weights& weights, Vertex vertex);
    /// One sweep; false when nothing flowed.
    bool sweep();
    /// Watches all that the last sweep may have set in motion.
    void spread(const Layer& layer, const Slopes& slopes, Weights& weights);
    /// Gives the layer its sand, and adds who has another volume now to `moved`.
    void store(Layer& layer, std::vector<Vertex>& moved);
    /// Whether sand has flowed in the last sweep at fewer than half of the vertices.
    [[nodiscard]] bool mostRest() const;
    /// Forgets edges that the last sweep cannot have set in motion. The layer must have got its sand.
    void forgetResting();
    /// The mesh is another: forgets all edges; these vertices had flowed.
    std::vector<Vertex> clear();

    [[nodiscard]] bool empty() const { return edges_.empty(); }
    [[nodiscard]] std::size_t size() const { return edges_.size(); }
    /// Vertices at whose edges an obstacle held sand back since this was asked for last.
    [[nodiscard]] std::vector<Vertex> takeHeldBack();

private:
    template <bool kBand, bool kHeld>
    void slide();
    template <bool kHeld>
    void flow();
    [[nodiscard]] std::int64_t underHeld(const Edge& edge, double difference, std::int64_t flux);
    [[nodiscard]] std::int32_t facetAt(const Layer& layer, const Slopes& slopes, std::int32_t slot);
    [[nodiscard]] std::int32_t localOf(const Layer& layer, Vertex vertex);
    /// As Facet::steepness; but sand that fills the room below an obstacle is no slope for the sand beside it, which
    /// leans on the obstacle: it would flow along it for ever.
    [[nodiscard]] double steepnessAtHeld(const Facet& facet);

    struct Local {
        Vertex vertex = kNobody;
        Place place;
        bool watched = false;  // all edges that depend on it are here
        bool heldBack = false;
        double underside = 0;  // [unit], where an obstacle holds
    };
    struct Sand {
        std::int64_t volume = 0;
        double star = 0;  // [probe unit²]
    };
    struct Inflow {
        std::int64_t net = 0, any = 0;  // sum of the fluxes, and all their bits
    };
    std::vector<Facet> facets_;        // their vertices by local number
    std::vector<std::int32_t> slots_;  // of each facet
    std::vector<double> sliding_;      // how strongly each facet slides, 0 to 1
    std::vector<Edge> edges_;          // their vertices and facets by local number
    std::vector<Side> sides_;          // of each edge
    std::vector<Local> locals_;
    std::vector<Sand> sands_;                 // by local number
    std::vector<double> heights_;             // by local number [unit]
    std::vector<Inflow> inflow_;              // by local number, of this sweep; else zero
    std::vector<std::uint8_t> flowed_;        // by local number: in the last sweep, at one of its edges
    std::vector<std::int32_t> local_;         // by vertex; kNobody: none
    std::vector<std::uint8_t> watchedSides_;  // by slot: a bit per corner
    std::vector<std::int32_t> facet_;         // by slot; kNobody: none
    std::vector<Vertex> heldBack_;
    bool band_ = false;
    const Underside* held_ = nullptr;
};

}  // namespace sand::tin
