// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sand/height_field.hpp"
#include "sand/scene.hpp"
#include "sand/tool.hpp"

namespace sand {

/// Instruction set the sweeps run with. Both give the same heights; automatic takes the fastest the machine has.
enum class CodePath : std::uint8_t { automatic, baseline };

/// Thermal erosion: sand slides wherever it lies steeper than the talus, until nothing moves.
///
/// A Jacobi sweep in face form: every flux is computed from the old heights, rounded once per face, subtracted on one
/// side and added on the other, so that volume is exact; no cell passes its neighbours; the sum of squares falls by at
/// least one in every sweep that moves anything, so that it ends. Only blocks that moved, or whose eight neighbours
/// did, are swept again: settled sand costs nothing, and the result is that of full sweeps bit for bit.
class Erosion {
public:
    static constexpr int kDefaultBlock = 16;  // [cell], digging takes 1.3 ms a step with 16, 2.2 with 32, 5.1 with 64

    /// Everything may move at first. blockSize is in [2, kMaxBlock] and never changes the result.
    Erosion(const HeightField& field, const Rules& rules, int blockSize = kDefaultBlock,
            CodePath path = CodePath::automatic);

    /// Somebody else changed these cells of `field`: they and their neighbours may move again.
    void touch(const HeightField& field, const Rect& cells);

    /// Runs `sweeps` sweeps over `field` and returns the volume that fell over an open rim [unit · cell]. No flux
    /// raises a cell above the underside of `obstacle`.
    std::int64_t sweep(HeightField& field, int sweeps, const Obstacle* obstacle = nullptr);

    /// Whether the next sweep would visit no block at all.
    [[nodiscard]] bool settled() const { return active_.empty(); }
    /// Whether the sweeps' own copy of these cells is no longer what it must be: memory went bad where nothing moves.
    [[nodiscard]] bool copyDiffers(const HeightField& field, const Rect& cells) const;
    /// Everything may move again: the tool has left, or the rules have changed.
    void wakeAll();
    /// The blocks in which sweep() changed a cell since this was called last.
    [[nodiscard]] std::vector<Rect> takeMoved();

    /// "x86-64-v3" or "baseline".
    [[nodiscard]] const char* codePath() const;

private:
    [[nodiscard]] Rect cellsOf(int block) const;
    [[nodiscard]] Rect blocksAround(const Rect& cells) const;
    void refreshGhosts(HeightField& field, const Rect& cells) const;
    /// The run of waiting blocks that begins with `block`, and the rows above it that wait in just the same run; they
    /// wait no longer. A wider run above is left whole: narrow patches cost more per cell.
    [[nodiscard]] Rect takePatch(int block);
    void sweepPatch(HeightField& field, const Rect& blocks, const Obstacle* obstacle, std::int64_t& outflow);
    void fillRoom(const HeightField& field, const Rect& cells, const Obstacle& obstacle);
    void mark(const Rect& blocks);
    void markAroundMoved(const Rect& blocks);
    void collectMarked();

    Rules rules_;
    HeightField scratch_;  // equals the field in every block that is not active
    int blockSize_;
    int across_, down_;  // blocks
    bool v3_;
    std::vector<int> active_;  // ascending
    // One number per block:
    std::vector<std::uint8_t> marked_;    // belongs to the next active set
    std::vector<std::uint8_t> waiting_;   // is active and not yet in a patch of this sweep
    std::vector<std::uint8_t> movedNow_;  // changed in the sweep that visited it last
    std::vector<std::uint8_t> moved_;     // changed since takeMoved()
    // Rows of blocks [from, to) that hold a mark: on a large field most hold none.
    int markedFrom_ = 0;
    int markedTo_ = 0;
    std::vector<std::int32_t> room_;  // [unit], see PatchSweep::room
};

}  // namespace sand
