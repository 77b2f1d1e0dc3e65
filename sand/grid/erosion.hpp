// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/executor.hpp"
#include "sand/grid/block_marks.hpp"
#include "sand/grid/displacement.hpp"
#include "sand/grid/inertia.hpp"
#include "sand/grid/net_flux.hpp"
#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"

namespace sand::grid {

struct FluxPatch;

/// Instruction set the sweeps run with. Both give the same heights; automatic takes the fastest the machine has.
enum class CodePath : std::uint8_t { automatic, baseline };

/// Thermal erosion: sand slides wherever it lies steeper than the talus, until nothing moves.
///
/// A Jacobi sweep in face form: every flux is computed from the old heights, rounded once per face, subtracted on one
/// side and added on the other, so that volume is exact. No flux is more than the share k of the difference it levels,
/// and the shares of a cell's four faces add up to less than one: no cell passes its neighbours, and the sum of squares
/// falls by at least one in every sweep that moves anything, so that it ends.
///
/// The default law has inertia: with a the difference across a face, m the slope and t the threshold,
/// q = M q_last + p (1 - t²/m²) a, cut to [0, k a]. The proofs need only the cut. Sand at rest starts to slide where
/// plain G would. With a band, a face up to the start threshold carries nothing unless sand slid in one of its two
/// cells, which means that some flowed through a face of that cell in the last sweep: moving sand stops at t. The pile
/// is plain G's to the third digit, in a tenth of the sweeps. M = n / (n + 25), at most 0.9, in the n-th sweep since
/// touch(): a pile so small that it rests early meets little inertia, and does not overshoot.
///
/// Only blocks in which sand flows, and of their neighbours those beside whose border it does, are swept again: settled
/// sand costs nothing, and the result is that of full sweeps bit for bit. Not thread-safe; an executor may be handed in
/// and never changes a result.
class Erosion {
public:
    static constexpr int kDefaultBlock = 8;  // [cell], a vector of AVX2: larger ones visit more sand at rest

    struct Options {
        int blockSize = kDefaultBlock;  // [cell], in [2, kMaxBlock]
        CodePath path = CodePath::automatic;
        const Ground* ground = nullptr;            // must outlive the erosion; null: sand without end
        const base::Executor* executor = nullptr;  // must outlive the erosion; null: the caller's thread does all
        bool skipSettled = true;                   // false visits every block in every sweep: for comparison
    };

    /// Everything may move at first.
    Erosion(const HeightField& field, const Rules& rules, const Options& options);
    Erosion(const HeightField& field, const Rules& rules) : Erosion(field, rules, Options{}) {}

    /// Somebody else changed these cells of the field: they and their neighbours may move again.
    void touch(const CellRect& cells);

    /// Runs at most `sweeps` sweeps over `field`, fewer when nothing moves any more, and returns the volume that fell
    /// over an open rim [unit · cell]. No flux raises a cell above the underside of `obstacle`.
    std::int64_t sweep(HeightField& field, int sweeps, const Obstacle* obstacle = nullptr);

    /// Adds what passed every face in the last sweep.
    void addFluxes(NetFlux& sum) const;

    /// Whether the next sweep would visit no block at all.
    [[nodiscard]] bool settled() const { return active_.empty() && marked_.empty(); }
    /// Sweeps that moved sand since touch(), as far as they matter: the age of the inertia.
    [[nodiscard]] int undisturbed() const { return undisturbed_; }
    /// What the next sweeps depend on beside the heights.
    [[nodiscard]] Inertia inertia() const;
    /// Goes on from there. Nothing is awake or asleep in an inertia: every block is visited once, and one at rest does
    /// not change.
    void resume(const Inertia& inertia);
    /// From now on; everything may move again.
    void changeRules(const Rules& rules);
    /// How many sweeps have been run since the start.
    [[nodiscard]] std::int64_t sweepsDone() const { return sweepsDone_; }
    /// Whether sand flows in a block of these cells that is not visited any more: memory went bad where nothing moves.
    [[nodiscard]] bool amiss(const CellRect& cells) const;
    /// Everything may move again: the tool has left, or the rules have changed.
    void wakeAll();
    /// Blocks in which sweep() changed a cell since this was called last, side by side ones as one.
    [[nodiscard]] std::vector<CellRect> takeMoved();

    /// "x86-64-v3" or "baseline".
    [[nodiscard]] const char* codePath() const;
    /// Of everything it keeps between sweeps [byte].
    [[nodiscard]] std::size_t bytes() const;

private:
    [[nodiscard]] CellRect cellsOf(const CellRect& blocks) const;
    [[nodiscard]] CellRect blocksAround(const CellRect& cells) const;
    void refreshGhosts(HeightField& field, const CellRect& cells) const;
    /// Finds anew in which cells sand slid, from the fluxes; only a band needs that.
    void findSliding();
    /// The run of waiting blocks that begins with `block`, and the rows above it that wait in just the same run; they
    /// wait no longer. A wider run above is left whole: narrow patches cost more per cell.
    [[nodiscard]] CellRect takePatch(int block);
    void collectPatches(HeightField& field);
    [[nodiscard]] std::int64_t sweepFluxes(const HeightField& field, const CellRect& blocks, float momentum,
                                           const Obstacle* obstacle);
    void balance(HeightField& field, const CellRect& blocks);
    void forEachPatch(const std::function<void(int)>& task) const;
    void markAroundMoved(const CellRect& blocks);
    /// Marks, in a row of blocks, those that lie beside flow at this side of a block; `flowed` by column.
    void markBeside(const std::uint8_t* flowed, int side, const CellRect& row);
    void collectMarked();
    void wakeTouched();

    Rules rules_;
    Options options_;
    int blockSize_;
    int across_, down_;  // blocks
    bool v3_;
    // Flux out of each cell to the east and to the north [unit] of the last sweep; column and row -1 hold what flows
    // over the western and southern rim. Zero wherever a block is not active.
    CellArray east_, north_;
    std::optional<CellArray> sliding_;  // with a band: in which cells sand slid in the last sweep
    std::int64_t sweepsDone_ = 0;
    int undisturbed_ = 0;                 // sweeps that moved sand since touch()
    std::vector<int> active_;             // ascending
    std::vector<CellRect> patches_;       // of this sweep [block]
    std::vector<std::int64_t> outflows_;  // of each patch
    BlockMarks marked_;                   // belong to the next active set
    BlockMarks moved_;                    // changed since takeMoved()
    // One number per block:
    std::vector<std::uint8_t> waiting_;   // is active and not yet in a patch of this sweep
    std::vector<std::uint8_t> movedNow_;  // where sand flowed in the sweep that visited it last, as bits of `flow`
};

}  // namespace sand::grid
