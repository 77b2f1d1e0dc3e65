// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "sand/grid/block_marks.hpp"
#include "sand/grid/displacement.hpp"
#include "sand/grid/erosion.hpp"
#include "sand/grid/snapshot.hpp"
#include "sand/grid/tile_hash.hpp"
#include "sand/model/surface.hpp"

namespace sand::grid {

/// Sand as a height field, over rock and between walls where the scene has them.
class GridSurface final : public Surface {
public:
    /// `options` say how the sand is swept, not what comes of it; their ground is the scene's own.
    GridSurface(const Rules& rules, const HeightField& field, std::shared_ptr<const Ground> ground,
                const Erosion::Options& options);
    [[nodiscard]] std::unique_ptr<Surface> clone() const override;

    [[nodiscard]] const Erosion& erosion() const { return erosion_; }

    void drag(const HeldTool& tool, std::span<const ProbePoint> path) override;
    void release(const HeldTool& tool, const ProbePoint& at) override;
    void sweep(int sweeps, const HeldTool* tool, const ProbePoint& at) override;
    void changeRules(const Rules& rules) override;
    void settle() override;
    void reset() override;

    void keep() override { beforeStroke_.keep(field_, erosion_.inertia(), outflow_); }
    void keep(const SurfaceCopy& copy) override { beforeStroke_.keep(dynamic_cast<const Snapshot&>(copy)); }
    void forget() override { beforeStroke_.forget(); }
    [[nodiscard]] std::shared_ptr<const SurfaceCopy> kept() const override;
    [[nodiscard]] bool hasKept() const override { return beforeStroke_.kept() != nullptr; }
    void putBackKept() override;

    [[nodiscard]] std::shared_ptr<const SurfaceCopy> copy() const override;
    [[nodiscard]] SurfaceReader reader() const override;
    void replace(const SurfaceCopy& copy) override;

    [[nodiscard]] std::int64_t outflow() const override { return outflow_; }        // [unit · cell]
    [[nodiscard]] std::int64_t volume() const override { return field_.volume(); }  // likewise
    [[nodiscard]] bool settled() const override { return erosion_.settled(); }
    [[nodiscard]] int age() const override { return erosion_.undisturbed(); }

    [[nodiscard]] std::uint64_t hash() override { return hash_.update(field_); }
    void audit(int tiles) override;
    [[nodiscard]] const HashTiles& hashTiles() const override { return hash_; }
    [[nodiscard]] std::vector<std::int32_t> valuesOf(int tile) const override;
    void corrupt(int column, int row, int bit) override;

    [[nodiscard]] double height(double x, double y) const override;
    [[nodiscard]] SurfaceData data() const override { return GridData{field_, ground_.get()}; }
    [[nodiscard]] SurfaceChange takeChange() override;

private:
    void touch(const CellRect& cells);
    void touchAll();

    Rules rules_;
    std::shared_ptr<const Ground> ground_;
    HeightField field_;
    Erosion erosion_;
    TileHash hash_;
    std::int64_t outflow_ = 0;
    std::shared_ptr<const base::Bytes> start_;  // the scene's heights, compressed; copies of a replica share them
    Undo beforeStroke_;                         // the last one
    std::optional<BlockMarks> changed_;         // since takeChange(); nullopt: everything may have
};

}  // namespace sand::grid
