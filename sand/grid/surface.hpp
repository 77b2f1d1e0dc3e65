// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "sand/grid/block_marks.hpp"
#include "sand/grid/displacement.hpp"
#include "sand/grid/erosion.hpp"
#include "sand/grid/tile_copy.hpp"
#include "sand/grid/tile_hash.hpp"
#include "sand/grid/undo.hpp"
#include "sand/model/movement.hpp"
#include "sand/model/surface.hpp"

namespace sand::grid {

/// Sand as a height field, with the scene's rock and wall cells. Surface documents the overridden functions.
class GridSurface final : public Surface {
public:
    /// `options` choose how the sand is swept; they never change the result. `ground` replaces `options.ground`, and is
    /// null without rock and wall cells. `start` is Start::packed; if it is null, the surface compresses `field`.
    GridSurface(const Rules& rules, HeightField field, std::shared_ptr<const Ground> ground,
                const Erosion::Options& options, std::shared_ptr<const base::Bytes> start = nullptr);
    [[nodiscard]] std::unique_ptr<Surface> clone() const override;

    [[nodiscard]] const Erosion& erosion() const { return erosion_; }

    void drag(const Tool& tool, std::span<const ProbePoint> path) override;
    [[nodiscard]] const RefusedPresses& refusedPresses() const override { return refused_; }
    void release(const Tool& tool, const ProbePoint& probe) override;
    void arrive(const Tool& tool, const ProbePoint& probe) override;
    void slideCoarsely(const CellRect& way, const Tool* tool, const ProbePoint& probe) override;
    Swept sweep(const SweepPart& part, const Tool* tool, const ProbePoint& probe) override;
    void changeRules(const Rules& rules) override;
    [[nodiscard]] bool settle() override;
    [[nodiscard]] bool settlesBySweeps() const override { return ground_ != nullptr; }
    [[nodiscard]] std::int64_t sweepCost() const override { return std::int64_t{field_.columns()} * field_.rows(); }
    void reset() override;

    void keep() override { beforeStroke_.keep(field_, erosion_.inertia(), outflow_); }
    void forget() override { beforeStroke_.forget(); }
    [[nodiscard]] bool hasKept() const override { return beforeStroke_.any(); }
    void putBackKept() override;

    [[nodiscard]] std::shared_ptr<const SurfaceCopy> copy() const override;
    [[nodiscard]] Copies beginCopy() const override;
    bool continueCopy(std::int64_t cells) const override;
    [[nodiscard]] SurfaceReader reader() const override;
    void replace(const SurfaceCopy& copy) override;
    void encodeInto(base::ByteWriter& writer) const override;
    void encodeKept(base::ByteWriter& writer) const override { beforeStroke_.encodeInto(field_, writer); }
    [[nodiscard]] std::function<void()> decode(std::span<const std::uint8_t> sand, std::span<const std::uint8_t> kept,
                                               const Decoding& how) override;

    [[nodiscard]] std::shared_ptr<SurfaceRecord> record() override;
    void follow(SurfaceRecords records) override { followed_.follow(std::move(records)); }
    void followAfterRestore(SurfaceRecords records) override { followed_.followAfterRestore(std::move(records)); }
    [[nodiscard]] const SurfaceRecords& followed() const override { return followed_.now(); }
    [[nodiscard]] std::shared_ptr<SurfaceRecord> recordLike(const SurfaceRecord& parts,
                                                            const SurfaceRecord* moment) override;
    [[nodiscard]] std::shared_ptr<const SurfaceCopy> beginCopyOf(const SurfaceRecords& records) override;

    [[nodiscard]] std::int64_t outflow() const override { return outflow_; }        // [unit · cell]
    [[nodiscard]] std::int64_t volume() const override { return field_.volume(); }  // [unit · cell]
    [[nodiscard]] bool settled() const override { return erosion_.settled(); }
    [[nodiscard]] int age() const override { return erosion_.undisturbed(); }

    [[nodiscard]] std::uint64_t hash() override;
    void endStep(std::uint64_t number) override;
    [[nodiscard]] const Movement* movement() const override { return &movement_; }
    void resumeMovement(const Movement& movement) override { movement_ = movement; }
    void corruptMovement(int column, int row) override;
    void audit(int tiles) override;
    [[nodiscard]] const HashTiles& hashTiles() const override { return hash_; }
    [[nodiscard]] std::vector<std::int32_t> valuesOf(int tile) const override;
    void corrupt(int column, int row, int bit) override;

    [[nodiscard]] double height(double x, double y) const override;
    [[nodiscard]] HeightSpan heights() const override;
    [[nodiscard]] bool readsKept() const override { return true; }
    [[nodiscard]] std::optional<double> keptHeight(double x, double y) const override;
    [[nodiscard]] SurfaceData data() const override { return GridData{field_, ground_.get(), &movement_}; }
    [[nodiscard]] SurfaceChange takeChange() override;

private:
    /// Must be called before heights or fluxes of `cells` change. Undo, records and begun copies take their sand.
    void willChange(const CellRect& cells);
    /// Must be called before heights of `cells` change, beside completeCopiesOf().
    void willChangeHeights(const CellRect& cells);
    /// Must be called before the heights become those of `field`.
    void willBecome(const HeightField& field);
    /// Takes the rest of the sand whose heights the field has. Call willBecome() before the heights change.
    void resume(const SandRest& rest);
    /// Lets begun copies take the sand of `cells`, if they lack it.
    void completeCopiesOf(const CellRect& cells) const;
    /// Lets records forget tiles that a change of the whole field has left alone.
    void forgetEqual();
    /// Records a change of `cells` for hash and takeChange(). Call willChange() before it.
    void touch(const CellRect& cells);
    /// Records a change of the whole field.
    void touchAll();

    Rules rules_;
    std::shared_ptr<const Ground> ground_;
    HeightField field_;
    Erosion::Options how_;
    Erosion erosion_;
    TileHash hash_;
    Movement movement_;
    RefusedPresses refused_;
    std::int64_t outflow_ = 0;
    std::shared_ptr<const base::Bytes> start_;  // the scene's heights, compressed; clones share them
    Undo beforeStroke_;                         // sand for an undo
    mutable BegunCopies begun_;                 // no part of the sand
    FollowedRecords followed_;                  // no part of the sand
    std::optional<BlockMarks> changed_;         // blocks changed since takeChange(); nullopt: all
};

}  // namespace sand::grid
