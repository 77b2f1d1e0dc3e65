// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sand/grid/erosion.hpp"
#include "sand/model/step.hpp"
#include "sand/model/surface.hpp"
#include "sand/start.hpp"

namespace sand {

/// Of what encodeState() writes; a replica decodes this version alone.
inline constexpr std::uint32_t kStateVersion = 6;

/// The whole state of a replica, for whoever compresses it on another thread.
struct StateCopy {
    base::Bytes head;                                 // all but the sand
    std::shared_ptr<const SurfaceCopy> beforeStroke;  // null when there is nothing to undo
    std::shared_ptr<const SurfaceCopy> sand;

    /// What Replica::decodeState takes (compressed).
    [[nodiscard]] base::Bytes encode() const;
};

/// A replica: the sand, and the one function that changes it.
///
/// Two replicas that start from one scene and apply the same steps are equal bit for bit, whatever the compiler, the
/// number of threads or the size of the blocks. Not thread-safe.
class Replica {
public:
    /// `options` say how the sand of a height field is swept, not what comes of it; their ground is that of `start`.
    explicit Replica(const Start& start, const grid::Erosion::Options& options = {});
    Replica(const Replica& other);
    Replica& operator=(const Replica& other);
    Replica(Replica&&) noexcept = default;
    Replica& operator=(Replica&&) noexcept = default;
    ~Replica() = default;

    /// The tool displaces sand along the step's path, what an operator asked is done, then Rules::sweepsPerStep sweeps
    /// let the sand slide. Steps must come in order: throws std::logic_error when step.number is not stepNumber() + 1.
    ///
    /// A reset, a load, and an undo that has a stroke to undo, put back heights, outflow and the sand's inertia, and
    /// that step does not sweep: it ends with the sand exactly as it was. Step number, tool and material go on. A load
    /// of bytes that are no sand of this field changes nothing.
    void apply(const Step& step);

    [[nodiscard]] const Rules& rules() const { return rules_; }  // now: an operator may have tuned the scene's
    [[nodiscard]] const Surface& surface() const { return *surface_; }
    [[nodiscard]] double cellSize() const { return cellSize_; }  // [scene unit], a TIN's nominal one
    [[nodiscard]] std::uint64_t stepNumber() const { return stepNumber_; }
    /// Lost over an open rim, and all there is [unit · cell; of a TIN: unit · probe unit² / 6].
    [[nodiscard]] std::int64_t outflow() const { return surface_->outflow(); }
    [[nodiscard]] std::int64_t volume() const { return surface_->volume(); }
    [[nodiscard]] ProbePoint probe() const { return probe_; }  // where the tool is
    [[nodiscard]] double toolRadius() const {                  // [scene unit]
        return rules_.toolRadius * cellSize_ / kProbePerCell;
    }
    [[nodiscard]] ToolShape toolShape() const { return rules_.toolShape(); }
    [[nodiscard]] Heading heading() const { return heading_; }  // of the tool, as rules or a hand turned it last
    [[nodiscard]] bool engaged() const { return engaged_; }
    /// Whether an undo would change anything. A stroke is the steps in which the tool touches, from the first after one
    /// in which it hovered; only the last is kept, until an undo, a reset or a load.
    [[nodiscard]] bool canUndo() const { return surface_->hasKept(); }
    /// Whether no block of sand moves any more: the next sweeps cost nothing.
    [[nodiscard]] bool settled() const { return surface_->settled(); }

    /// Hash of everything a later step depends on: heights, tool pose, step number, outflow, and tool
    /// and material where they are not the scene's. Of the sand's inertia only
    /// its age: a wrong flux shows in the heights of the next step, and a wrong undo in those after it.
    [[nodiscard]] std::uint64_t stateHash();
    /// Hashes the next `tiles` hash tiles again from memory, changed or not, so that silent corruption shows.
    void audit(int tiles) { surface_->audit(tiles); }
    [[nodiscard]] const HashTiles& hashTiles() const { return surface_->hashTiles(); }
    [[nodiscard]] std::vector<std::int32_t> valuesOf(int tile) const { return surface_->valuesOf(tile); }

    /// Returns what changed of surface() since the last call, and everything at the first one.
    [[nodiscard]] SurfaceChange takeChange() { return surface_->takeChange(); }

    /// What a replica of a scene takes at the very least, with the scene it starts from [byte].
    [[nodiscard]] static std::int64_t leastBytes(const Start& start);
    /// The same of a height field of this size.
    [[nodiscard]] static std::int64_t leastBytes(int columns, int rows);

    /// The sand now, for whoever compresses it on another thread.
    [[nodiscard]] std::shared_ptr<const SurfaceCopy> copySand() const { return surface_->copy(); }
    [[nodiscard]] SurfaceReader sandReader() const { return surface_->reader(); }
    [[nodiscard]] StateCopy copyState() const;
    /// The whole state, for a replica that must start from here (compressed).
    [[nodiscard]] base::Bytes encodeState() const { return copyState().encode(); }
    /// Throws base::FormatError when the bytes are no state of this scene; the replica is then unchanged.
    void decodeState(std::span<const std::uint8_t> bytes);

    /// Flips one bit of one cell's height behind the hash's back, the lowest being 0: a fault for tests and drills of
    /// the lockstep proof.
    void corrupt(int column, int row, int bit = 0) { surface_->corrupt(column, row, bit); }

private:
    [[nodiscard]] HeldTool tool() const { return {rules_.toolShape(), heading_}; }
    void tune(const Tuning& tuning);
    void press();
    /// Does reset, undo or load; false when there was nothing to do.
    bool putBack(const Edit& edit);

    Rules rules_, startRules_;
    double cellSize_;
    std::unique_ptr<Surface> surface_;
    std::uint64_t stepNumber_ = 0;
    ProbePoint probe_;
    Heading heading_;
    bool engaged_ = false;
};

}  // namespace sand
