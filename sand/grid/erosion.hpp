// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "base/code_path.hpp"
#include "base/executor.hpp"
#include "sand/grid/block_marks.hpp"
#include "sand/grid/displacement.hpp"
#include "sand/grid/erosion_walk.hpp"
#include "sand/grid/inertia.hpp"
#include "sand/grid/net_flux.hpp"
#include "sand/grid/tile_grid.hpp"
#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/owed.hpp"
#include "sand/model/rules.hpp"

namespace sand::grid {

/// Thermal erosion: sand slides wherever it is steeper than the talus, until all sand is at rest.
///
/// A sweep is a Jacobi iteration over the faces between cells: it computes all fluxes from the heights before the
/// sweep. docs/sand.md has the law of a flux with its constants, inertia and band, and the proofs that volume is exact
/// and that sliding ends. The proofs need only the cut of a flux at the share k of the height difference.
///
/// **Blocks.** A sweep visits the blocks in which sand flows, and each neighbour next to a border where sand flows.
/// Sand at rest costs no time. The result equals that of full sweeps bit for bit.
///
/// Threads: not thread-safe. An executor may share out the work of a sweep; it never changes a result.
class Erosion {
public:
    /// Default side of a block [cell]: one AVX2 vector. Larger blocks would visit more sand at rest.
    static constexpr int kDefaultBlock = 8;

    /// Choices of how to sweep. None of them changes the heights, except `ground`.
    struct Options {
        int blockSize = kDefaultBlock;  // side of a block [cell], clamped to [2, kMaxBlock]
        base::CodePath path = base::fastestCodePath();
        /// Rock and wall cells, which must outlive the Erosion. Null: sand of unlimited depth without walls.
        const Ground* ground = nullptr;
        /// Threads for the sweeps, which must outlive the Erosion. Null: the calling thread does all work.
        const base::Executor* executor = nullptr;
        /// Whether to skip blocks at rest. False visits every block in every sweep, for comparison.
        bool skipSettled = true;
    };

    /// Prepares the sweeps of `field`. The first sweep visits every block that is not certainly at rest.
    Erosion(const HeightField& field, const Rules& rules, const Options& options);
    Erosion(const HeightField& field, const Rules& rules) : Erosion(field, rules, Options{}) {}

    /// Wakes the blocks of `cells` and their neighbours, and resets the age of the inertia. Call it after other code
    /// has changed heights in `cells`, or has removed an obstacle from them.
    void touch(const CellRect& cells);
    /// Makes the next sweep visit the blocks of `cells` and their neighbours. Does not reset the age of the inertia.
    void wake(const CellRect& cells);

    /// The result of sweeps.
    struct Swept {
        std::int64_t outflow = 0;  // volume that fell over an open rim [unit · cell]
        /// Whether the last sweep moved no sand. It does not depend on which blocks were visited.
        bool still = false;
    };
    /// Runs the sweeps of `part` over `field`; stops earlier after a sweep in which no sand flows.
    ///
    /// No flux raises a cell above the underside of `obstacle`, which is null without a tool. Calls
    /// `willChange(cells)`, unless it is empty, before heights or fluxes of these cells may change.
    Swept sweep(HeightField& field, const SweepPart& part, const Obstacle* obstacle = nullptr,
                const std::function<void(const CellRect&)>& willChange = {});
    /// Runs a step of `sweeps` sweeps. Returns the volume that fell over an open rim [unit · cell].
    std::int64_t sweep(HeightField& field, int sweeps, const Obstacle* obstacle = nullptr) {
        return sweep(field, SweepPart::all(sweeps), obstacle).outflow;
    }

    /// Adds the flux of each face in the last sweep to `sum`.
    void addFluxes(NetFlux& sum) const;

    /// Returns whether sweeps have found all sand at rest, so that the next sweep would visit no block.
    [[nodiscard]] bool settled() const { return active_.empty() && marked_.empty(); }
    /// Returns the cells that the next sweep visits if no cell is touched before.
    [[nodiscard]] std::int64_t activeCells() const;
    /// Returns the age of the inertia: the number of sweeps that moved sand since touch(), at most
    /// Inertia::kMostCounted [sweep].
    [[nodiscard]] int undisturbed() const { return undisturbed_; }
    /// Returns everything except heights and rules that later sweeps depend on: the last fluxes and their age. Calls of
    /// the same moment share the packed fluxes, so that only the first one takes time.
    [[nodiscard]] Inertia inertia() const;
    /// Returns for each tile of `grid` whether its cells, or the rim beside them, may have a flux other than 0.
    [[nodiscard]] std::vector<bool> tilesWithFlux(const TileGrid& grid) const;
    /// Adds the fluxes of `cells` to `inertia`, with those over a western and a southern rim beside them.
    void addFluxes(CellRect cells, Inertia& inertia) const;
    /// Replaces fluxes and age by those of `inertia`. Wakes every block, because an Inertia does not record which
    /// blocks were at rest. A visit changes no block at rest.
    void resume(const Inertia& inertia);
    /// Replaces the rules, wakes every block, and resets the age of the inertia.
    void changeRules(const Rules& rules);
    /// Returns the number of sweeps since construction.
    [[nodiscard]] std::int64_t sweepsDone() const { return sweepsDone_; }
    /// Returns whether a cell of `cells` has a flux other than 0 although its block is at rest. Only corrupted memory
    /// can cause that. A cell at the western or southern rim also has the flux over this rim.
    [[nodiscard]] bool amiss(const CellRect& cells) const;
    /// Makes the next sweep visit every block. Does not reset the age of the inertia.
    void wakeAll();
    /// Returns rectangles that contain all cells changed by sweep() since the last call [cell]. Each is a run of blocks
    /// within one row of blocks. They are disjoint and ordered row by row from the south-west.
    [[nodiscard]] std::vector<CellRect> takeMoved();

    /// Returns the memory that is kept between sweeps [byte].
    [[nodiscard]] std::size_t bytes() const;

private:
    [[nodiscard]] Inertia packedInertia() const;
    [[nodiscard]] CellRect cellsOf(const CellRect& blocks) const;
    /// Returns the blocks of `cells` and one more on each side [block].
    [[nodiscard]] CellRect blocksAround(const CellRect& cells) const;
    /// Makes one sweep over the cells of swept_. Returns the outflow [unit · cell].
    std::int64_t sweepOnce(HeightField& field, float momentum, const Obstacle* obstacle);
    /// Marks the blocks that the next sweep must visit because sand flowed in this sweep.
    void markAroundMoved();
    /// Adds the marked blocks to the active ones.
    void wakeTouched();
    /// Removes active blocks that are certainly at rest, where no flux has been written. A field that moves little then
    /// needs little memory for fluxes, although its first sweep visits all blocks. Leaves swept_ in any state.
    void leaveOutResting(const HeightField& field);
    /// Notes that fluxes of the active blocks may be written.
    void noteWritten();
    /// Gives the memory of fluxes back to the system where sand has rested for a while.
    void releaseRest();

    Rules rules_;
    Options options_;
    int blockSize_;
    int across_, down_;  // size of the field [block]
    // Fluxes of the last sweep from each cell to the east and to the north [unit]. Column -1 and row -1 are the fluxes
    // across the western and the southern rim. All fluxes of a block that is not active are 0.
    CellArray east_, north_;
    enum class Written : std::uint8_t { no, earlier, lately };
    // By row of blocks: whether its fluxes may differ from 0 or take memory, and since when.
    std::vector<Written> written_;
    int calls_ = 0;  // of sweep() since releaseRest() has last looked at written_
    std::int64_t sweepsDone_ = 0;
    int undisturbed_ = 0;  // age of the inertia [sweep]
    // Runs of blocks within one row of blocks, row by row from the south-west [block]. Runs of a row do not touch.
    std::vector<CellRect> active_;  // runs for the next sweep
    std::vector<CellRect> swept_;   // runs of the last sweep
    BlockMarks marked_;             // blocks for the next active set
    BlockMarks moved_;              // blocks changed since takeMoved()
    FlowBits flowed_;               // bits of this sweep; 0 between sweeps
    ErosionWalk walk_;
    std::vector<std::uint32_t> steep_;       // memory of RestingBlocks
    mutable std::optional<Inertia> packed_;  // of this moment; nullopt until inertia() is called
};

}  // namespace sand::grid
