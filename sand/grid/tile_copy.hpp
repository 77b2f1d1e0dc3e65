// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "sand/grid/erosion.hpp"
#include "sand/grid/packed_cells.hpp"
#include "sand/grid/tile_grid.hpp"
#include "sand/grid/undo.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/surface.hpp"

namespace sand::grid {

/// The sand of one moment, which is copied tile by tile while the surface changes.
///
/// A tile is copied before it first changes, or by copyMore(). Each tile is packed, so that the copy of sand that all
/// moves takes a few bytes for each cell.
///
/// Threads: until complete(), only the thread of the surface may use it. It never changes afterwards, and any thread
/// may then read it. No other thread ever reads the sand of the surface.
class TileCopy final : public SurfaceCopy {
public:
    /// Begins a copy of this sand. Takes time for the number of tiles, not of cells.
    TileCopy(const HeightField& field, const Erosion& erosion, std::int64_t outflow /* [unit · cell] */);

    /// Must be called before heights or fluxes of `cells` change.
    void willChange(const HeightField& field, const Erosion& erosion, const CellRect& cells);
    /// Copies at least `cells` further cells, or all that are left.
    void copyMore(const HeightField& field, const Erosion& erosion, std::int64_t cells);
    [[nodiscard]] bool complete() const override { return left_ == 0; }

    void encodeInto(base::ByteWriter& writer, const std::function<void()>& between) const override;
    [[nodiscard]] std::size_t stripes() const override;
    [[nodiscard]] const TileGrid& grid() const { return grid_; }
    /// Returns the heights of a tile. Requires complete().
    [[nodiscard]] const PackedCells& heights(std::size_t tile) const { return *heights_[tile]; }

private:
    void take(const HeightField& field, const Erosion& erosion, std::size_t tile);

    TileGrid grid_;
    std::vector<std::unique_ptr<const PackedCells>> heights_;  // of each tile; null if it is not copied yet
    std::vector<bool> flows_;                                  // tiles that may have fluxes
    Inertia inertia_;
    std::int64_t outflow_;  // [unit · cell]
    std::size_t left_;      // tiles that are not copied yet
    std::size_t next_ = 0;  // copyMore() has visited all tiles before this one
};

/// Earlier sand: that of a TileCopy, with other tiles in place of its own. Shares all tiles.
class KeptCopy final : public SurfaceCopy {
public:
    using Tiles = std::vector<std::shared_ptr<const PackedCells>>;  // null: that of `now`

    KeptCopy(Tiles tiles, Inertia inertia, std::int64_t outflow /* [unit · cell] */,
             std::shared_ptr<const TileCopy> now);
    /// Takes the sand that is kept for an undo.
    KeptCopy(const Undo& undo, std::shared_ptr<const TileCopy> now)
        : KeptCopy(undo.tiles(), undo.inertia(), undo.outflow(), std::move(now)) {}
    [[nodiscard]] bool complete() const override { return now_->complete(); }
    void encodeInto(base::ByteWriter& writer, const std::function<void()>& between) const override;
    [[nodiscard]] std::size_t stripes() const override;

private:
    Tiles heights_;
    Inertia inertia_;
    std::int64_t outflow_;  // [unit · cell]
    std::shared_ptr<const TileCopy> now_;
};

/// The TileCopies that a surface completes, the oldest first. A copy of a surface completes none.
class BegunCopies {
public:
    BegunCopies() = default;
    BegunCopies(const BegunCopies&) {}
    BegunCopies& operator=(const BegunCopies& other) {
        if (this != &other) {
            copies_.clear();
        }
        return *this;
    }
    BegunCopies(BegunCopies&&) noexcept = default;
    BegunCopies& operator=(BegunCopies&&) noexcept = default;
    ~BegunCopies() = default;

    void begin(const std::shared_ptr<TileCopy>& copy) {
        forgetOthers();
        copies_.push_back(copy);
    }
    /// Calls visit(copy) for each copy that is neither complete nor dropped, until it returns false. Forgets the
    /// others.
    template <class Visit>
    void forEach(const Visit& visit) {
        forgetOthers();
        for (const std::weak_ptr<TileCopy>& begun : copies_) {
            if (const std::shared_ptr<TileCopy> copy = begun.lock(); copy != nullptr && !visit(*copy)) {
                return;
            }
        }
    }
    /// Returns whether there may be such a copy.
    [[nodiscard]] bool any() const { return !copies_.empty(); }

private:
    void forgetOthers() {
        std::erase_if(copies_, [](const std::weak_ptr<TileCopy>& begun) {
            const std::shared_ptr<TileCopy> copy = begun.lock();
            return copy == nullptr || copy->complete();
        });
    }

    std::vector<std::weak_ptr<TileCopy>> copies_;
};

}  // namespace sand::grid
