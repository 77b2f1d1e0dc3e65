// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "sand/model/surface.hpp"
#include "sand/tin/flow/erosion.hpp"
#include "sand/tin/geometry/surface_view.hpp"
#include "sand/tin/geometry/tin_start.hpp"
#include "sand/tin/mesh/neighbourhood.hpp"
#include "sand/tin/record.hpp"
#include "sand/tin/refine/coarsening.hpp"
#include "sand/tin/snapshot.hpp"
#include "sand/tin/tile_hash.hpp"
#include "sand/tin/tool/displacement.hpp"
#include "sand/tin/undo.hpp"

namespace sand::tin {

/// Sand as a TIN: its VertexSand, the imprint of the tool, and erosion. Surface documents the overridden functions.
class TinSurface final : public Surface {
public:
    /// Triangulates `start`, which must not be null. Uses rim, threshold and start threshold of `rules`.
    TinSurface(const Rules& rules, std::shared_ptr<const TinStart> start);
    TinSurface(const TinSurface& other);
    TinSurface& operator=(const TinSurface&) = delete;
    [[nodiscard]] std::unique_ptr<Surface> clone() const override { return std::make_unique<TinSurface>(*this); }

    [[nodiscard]] const VertexSand& layer() const { return layer_; }
    [[nodiscard]] const TinStart& start() const { return *start_; }

    void drag(const Tool& tool, std::span<const ProbePoint> path) override;
    [[nodiscard]] const RefusedPresses& refusedPresses() const override { return refused_; }
    // These do nothing, because Erosion itself finds the sand that the tool holds back.
    void release(const Tool&, const ProbePoint&) override {}
    void arrive(const Tool&, const ProbePoint&) override {}
    void hold(const Tool& tool, const ProbePoint& probe) override;
    void leave(const Tool& tool) override;
    Swept sweep(const SweepPart& part, const Tool* tool, const ProbePoint& probe) override;
    void changeRules(const Rules& rules) override;
    [[nodiscard]] bool settle() override;
    [[nodiscard]] std::int64_t sweepCost() const override;
    void reset() override;

    void keep() override { beforeStroke_.keep(layer_, state_); }
    void forget() override { beforeStroke_.forget(); }
    [[nodiscard]] bool hasKept() const override { return beforeStroke_.any(); }
    void putBackKept() override { replace(*beforeStroke_.copy()); }

    [[nodiscard]] std::shared_ptr<const SurfaceCopy> copy() const override;
    [[nodiscard]] Copies beginCopy() const override { return {copy(), beforeStroke_.copy()}; }
    [[nodiscard]] SurfaceReader reader() const override;
    void replace(const SurfaceCopy& copy) override;
    void encodeInto(base::ByteWriter& writer) const override { copy()->encodeInto(writer, {}); }
    void encodeKept(base::ByteWriter& writer) const override { beforeStroke_.copy()->encodeInto(writer, {}); }
    [[nodiscard]] std::function<void()> decode(std::span<const std::uint8_t> sand, std::span<const std::uint8_t> kept,
                                               const Decoding& how) override;

    [[nodiscard]] std::shared_ptr<SurfaceRecord> record() override { return records_.record(layer_, state_); }
    void follow(SurfaceRecords records) override { records_.follow(layer_, std::move(records)); }
    void followAfterRestore(SurfaceRecords records) override {
        records_.followAfterRestore(layer_, std::move(records));
    }
    [[nodiscard]] const SurfaceRecords& followed() const override { return records_.followed(); }
    [[nodiscard]] std::shared_ptr<SurfaceRecord> recordLike(const SurfaceRecord& parts,
                                                            const SurfaceRecord* moment) override;
    [[nodiscard]] std::shared_ptr<const SurfaceCopy> beginCopyOf(const SurfaceRecords& records) override {
        return records_.copyOf(layer_, records);
    }

    [[nodiscard]] std::int64_t outflow() const override { return state_.outflow; }
    [[nodiscard]] std::int64_t volume() const override { return static_cast<std::int64_t>(layer_.volume()); }
    [[nodiscard]] bool settled() const override { return erosion_.settled(); }
    [[nodiscard]] bool atRest() const override { return settled() && (detail_.removals == 0 || coarsening_.done()); }
    [[nodiscard]] int age() const override { return 0; }

    [[nodiscard]] std::uint64_t hash() override { return hash_.update(state_); }
    void audit(int tiles) override;
    [[nodiscard]] const HashTiles& hashTiles() const override { return hash_; }
    [[nodiscard]] std::vector<std::int32_t> valuesOf(int tile) const override;
    void corrupt(int column, int row, int bit) override;

    [[nodiscard]] double height(double x, double y) const override;
    [[nodiscard]] HeightSpan heights() const override;
    [[nodiscard]] SurfaceData data() const override { return TinData{*view_}; }
    [[nodiscard]] SurfaceChange takeChange() override;

private:
    /// Returns the Displacement for `tool`, which is created again only if the tool differs from that of the last call.
    [[nodiscard]] Displacement& displacementOf(const Tool& tool);
    /// Returns the limits of every sand that this surface can have.
    [[nodiscard]] SandLimits limits() const;
    /// Prepares a layer_ that has just been put in place.
    void layerReplaced();
    /// Counts what a tool has done to the sand, and wakes the sand.
    void displaced(const Tool& tool, const Displacement::Work& done);
    /// Passes the changes of the mesh to erosion, hash, undo, coarsening and takeChange().
    void meshChanged();
    /// Reserves memory for further vertices, so that few steps have to move all vertices' data to a larger array.
    void reserve();
    /// Wakes the vertices within `reach` whose sand fills the room below the tool, because sand beside them may lean on
    /// the tool.
    void wakeFull(const Underside& under, const Box& reach);
    /// Passes a change of the heights of `vertices` to hash, undo, coarsening and takeChange().
    void sandMoved(const std::vector<Vertex>& vertices);

    std::shared_ptr<const TinStart> start_;
    DetailRules detail_;
    Rim rim_;
    std::int32_t threshold_, startThreshold_;
    VertexSand layer_;
    std::size_t startVertices_;  // of the start's mesh; constraints that cross may have added some
    TinState state_;
    RefusedPresses refused_;
    Coarsening coarsening_;
    Erosion erosion_;
    TileHash hash_;
    std::optional<SurfaceView> view_;  // of layer_, created again when layer_ is replaced
    Undo beforeStroke_;
    Records records_;                           // no part of the sand
    std::optional<TinChange> changed_;          // since takeChange(); nullopt: everything
    std::optional<Displacement> displacement_;  // for the tool of the last displacementOf()
    std::shared_ptr<Neighbourhood> neighbourhood_ = std::make_shared<Neighbourhood>();
    bool sawAll_ = false;                         // neighbourhood_ shows the current mesh around the tool
    std::optional<Imprint::Pose> held_;           // obstacle of the last sweeps; saves work only
    std::vector<Vertex> moved_;                   // scratch memory of sweep() and settle()
    mutable std::int32_t lastFound_ = kNoNumber;  // triangle found last; the next search begins there
};

}  // namespace sand::tin
