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
    static constexpr int kDefaultBlock = 64;  // [cell]

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
    /// Sweeps the run of neighbouring active blocks that begins at active_[first]; returns the index behind it.
    std::size_t sweepStrip(HeightField& field, std::size_t first, const Obstacle* obstacle, std::int64_t& outflow);
    void fillRoom(const HeightField& field, const Rect& cells, const Obstacle& obstacle);
    void mark(const Rect& blocks);
    void collectMarked();

    Rules rules_;
    HeightField scratch_;  // equals the field in every block that is not active
    int blockSize_;
    int across_, down_;  // blocks
    bool v3_;
    std::vector<int> active_;           // ascending
    std::vector<std::uint8_t> marked_;  // per block: belongs to the next active set
    std::vector<std::uint8_t> moved_;   // per block: changed since takeMoved()
    std::vector<std::int32_t> room_;    // [unit], see StripSweep::room
};

}  // namespace sand
