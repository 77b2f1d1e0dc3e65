// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/byte_stream.hpp"
#include "sand/model/cell_array.hpp"
#include "sand/model/movement.hpp"
#include "sand/model/owed.hpp"
#include "sand/model/refused_press.hpp"
#include "sand/model/rules.hpp"
#include "sand/model/step.hpp"
#include "sand/model/surface_data.hpp"
#include "sand/model/surface_record.hpp"
#include "sand/model/tool.hpp"

namespace sand {

/// Hashes of the hash tiles of a surface. Their sum, modulo 2^64, is the hash of the surface. Every rank divides its
/// surface into the same hash tiles.
class HashTiles {
public:
    virtual ~HashTiles() = default;
    [[nodiscard]] int tileCount() const { return static_cast<int>(hashes_.size()); }
    [[nodiscard]] const std::vector<std::uint64_t>& tileHashes() const { return hashes_; }
    /// Returns the cells of hash tile `tile`. Returns an empty rectangle for a TIN, whose hash tiles are sets of
    /// vertices.
    [[nodiscard]] virtual CellRect cellsOf(int tile) const = 0;

protected:
    HashTiles() = default;
    HashTiles(const HashTiles&) = default;
    HashTiles& operator=(const HashTiles&) = default;
    HashTiles(HashTiles&&) = default;
    HashTiles& operator=(HashTiles&&) = default;
    std::vector<std::uint64_t> hashes_;
};

/// Snapshot of the sand, without rules and tool, for saving, loading and undo. Any thread may read it.
class SurfaceCopy {
public:
    SurfaceCopy() = default;
    SurfaceCopy(const SurfaceCopy&) = default;
    SurfaceCopy& operator=(const SurfaceCopy&) = default;
    virtual ~SurfaceCopy() = default;
    /// Writes the snapshot as compressed bytes for a SurfaceReader. Calls `between` meanwhile, at least once, unless
    /// it is empty. It may throw, in order to stop. Requires complete().
    virtual void encodeInto(base::ByteWriter& writer, const std::function<void()>& between) const = 0;
    /// Returns what encodeInto() writes.
    [[nodiscard]] base::Bytes encode(const std::function<void()>& between = {}) const {
        base::ByteWriter writer;
        encodeInto(writer, between);
        return writer.take();
    }
    /// Returns how often encodeInto() calls `between`. Requires complete().
    [[nodiscard]] virtual std::size_t stripes() const { return 1; }
    /// Returns whether the snapshot has all of its sand. Surface::beginCopy() begins one that gets it later. Call it
    /// in the thread of the surface.
    [[nodiscard]] virtual bool complete() const { return true; }
};

/// The result of sweeps.
struct Swept {
    std::int64_t sweeps = 0;  // that have run. A replica that was healed may run one more, which moves no sand
    bool still = false;       // whether the last sweep moved no sand. All replicas agree about it
};

/// Function that decodes the bytes of SurfaceCopy::encode() for one surface. It throws base::FormatError if the bytes
/// are not sand for that surface, or if further bytes follow. Any thread may call it, also after the surface is
/// destroyed.
using SurfaceReader = std::function<std::shared_ptr<const SurfaceCopy>(std::span<const std::uint8_t>)>;

/// Lowest and highest height of some sand [unit].
struct HeightSpan {
    double lowest = 0, highest = 0;
    friend bool operator==(const HeightSpan&, const HeightSpan&) = default;
};

/// The sand of one replica: a height field or a TIN. Only Replica changes it: with steps, or as a whole when it loads a
/// state. Not thread-safe.
class Surface : public SurfaceRecorder {
public:
    /// Returns a copy of the sand and of all that later steps depend on. The copy's first takeChange() returns a whole
    /// change.
    [[nodiscard]] virtual std::unique_ptr<Surface> clone() const = 0;

    /// Moves the tool along `path`, which begins where the tool is and has at least two points, and displaces the sand.
    /// Two equal points press the sand without a direction.
    virtual void drag(const Tool& tool, std::span<const ProbePoint> path) = 0;
    /// Returns the presses of drag() that were refused.
    [[nodiscard]] virtual const RefusedPresses& refusedPresses() const = 0;
    /// Wakes the sand that `tool` held back while its centre was at `probe`.
    virtual void release(const Tool& tool, const ProbePoint& probe) = 0;
    /// Wakes the sand that `tool` reaches, whose centre has come to `probe`. A tool can make a slope steeper without
    /// cutting sand. Two opposite steps beside a face cancel each other until the tool limits one of them.
    virtual void arrive(const Tool& tool, const ProbePoint& probe) = 0;
    /// Called before the sweeps of a step in which a tool that is in the sand, or above it, does not move.
    virtual void hold(const Tool&, const ProbePoint&) {}
    /// Called after the tool has left the sand. A TIN then keeps the tool's outline in its mesh, or removes it,
    /// as tin::Settings::keepConstraints says.
    virtual void leave(const Tool&) {}
    /// Called before the sweeps of a step that has moved the tool, if the rules give it a coarse phase. `way` contains
    /// the cells of the tool's centres, before the step and in it. `tool` and `probe` are as for sweep().
    virtual void slideCoarsely(const CellRect& /* way */, const Tool* /* tool */, const ProbePoint& /* probe */) {}
    /// Lets the sand slide for the sweeps of `part`, or until a sweep moves no sand. `tool` is an obstacle with its
    /// centre at `probe`; null without one. A TIN takes each call for a whole step.
    virtual Swept sweep(const SweepPart& part, const Tool* tool, const ProbePoint& probe) = 0;
    /// Replaces the rules and wakes all sand.
    virtual void changeRules(const Rules& rules) = 0;
    /// Lets all sand come to rest at once. Ignores rock, walls and tools. Returns false if sand still moves after as
    /// much work as a step may take; sweeps then bring the sand to rest.
    [[nodiscard]] virtual bool settle() = 0;
    /// Returns whether there is rock or a wall that settle() would ignore. Only sweeps then bring the sand to rest.
    [[nodiscard]] virtual bool settlesBySweeps() const { return false; }
    /// Returns the time of a sweep in which all sand moves, at least that of the field's cells [cell of a grid].
    [[nodiscard]] virtual std::int64_t sweepCost() const = 0;
    /// Returns the work that settle() may take in a step [cell of a grid, in a sweep]. It is about half a second for
    /// 512 x 512 cells.
    [[nodiscard]] std::int64_t mostSettlingWork() const {
        constexpr std::int64_t kVisits = 1536, kLeastCells = 512 * 512;
        return kVisits * std::max(sweepCost(), kLeastCells);
    }
    /// Restores the sand that the scene began with, and sets the outflow to 0.
    virtual void reset() = 0;

    /// Keeps a snapshot of the current sand for an undo, in place of the one kept before.
    virtual void keep() = 0;
    /// Drops the snapshot that is kept for an undo.
    virtual void forget() = 0;
    [[nodiscard]] virtual bool hasKept() const = 0;
    /// Restores the kept snapshot, which stays kept. Requires hasKept().
    virtual void putBackKept() = 0;

    /// Returns a snapshot of the current sand.
    [[nodiscard]] virtual std::shared_ptr<const SurfaceCopy> copy() const = 0;
    /// Snapshots of one moment, of the current sand and of the sand that is kept for an undo. `kept` is null if
    /// hasKept() is false.
    struct Copies {
        std::shared_ptr<const SurfaceCopy> sand, kept;
    };
    /// Begins snapshots of this moment, which are only for encodeInto(). Parts of the sand are copied before they next
    /// change, and the other parts by continueCopy(). A surface completes all snapshots that their owners still hold.
    ///
    /// Until complete(), the snapshots belong to the thread of the surface. Then they never change again, and any
    /// thread may read them.
    [[nodiscard]] virtual Copies beginCopy() const = 0;
    /// Copies at least `cells` further cells, or all that are left, into the oldest begun snapshot that is not
    /// complete. Returns false if all begun snapshots are complete.
    virtual bool continueCopy(std::int64_t /* cells */) const { return false; }
    /// Returns the function that decodes snapshots for this surface.
    [[nodiscard]] virtual SurfaceReader reader() const = 0;
    /// Replaces the sand by `copy`, which must come from copy() or a SurfaceReader of this surface.
    virtual void replace(const SurfaceCopy& copy) = 0;
    /// Writes what copy() and the kept snapshot would, without copying the sand. encodeKept() requires hasKept().
    virtual void encodeInto(base::ByteWriter& writer) const = 0;
    virtual void encodeKept(base::ByteWriter& writer) const = 0;
    /// Options of decode().
    struct Decoding {
        /// Called again and again, unless it is empty, with the number of bytes that were decoded since the last call.
        /// A TIN never calls it, because a TIN is small.
        const std::function<void(std::size_t)>& decoded;
        /// Whether the surface may have any sand after a base::FormatError. A height field then has no second copy of
        /// its heights in memory. Call forget() and follow({}) before.
        bool inPlace = false;
    };
    /// Decodes what encodeInto() and encodeKept() wrote; `kept` is empty if no sand was kept. Throws base::FormatError
    /// if the bytes are not sand for this surface. Returns a function that replaces the sand and the kept sand by the
    /// decoded ones. It throws at most std::bad_alloc. Call it at most once, before the surface changes otherwise; only
    /// changeRules(), forget() and follow() may be called before.
    [[nodiscard]] virtual std::function<void()> decode(std::span<const std::uint8_t> sand,
                                                       std::span<const std::uint8_t> kept, const Decoding& how) = 0;

    /// Returns the volume that left the field over an open rim [unit · cell; for a TIN: unit · probe unit² / 6].
    [[nodiscard]] virtual std::int64_t outflow() const = 0;
    /// Returns the exact volume of all sand, in the unit of outflow().
    [[nodiscard]] virtual std::int64_t volume() const = 0;
    /// Returns whether sweeps have found all sand at rest. Returns false before the first sweep.
    [[nodiscard]] virtual bool settled() const = 0;
    /// Returns whether further sweeps change nothing. All sand is at rest, and a TIN has no vertex left that it could
    /// remove. Programs that number steps ask it; no step depends on it.
    [[nodiscard]] virtual bool atRest() const { return settled(); }
    /// Returns the age of the inertia that sand carries from step to step [sweep]; 0 for a TIN, which carries none.
    [[nodiscard]] virtual int age() const = 0;

    /// Called at the end of each step. A height field records in which hash tiles step `number` has changed a height.
    virtual void endStep(std::uint64_t /* number */) {}
    /// Returns when the sand moved last, or null for a TIN.
    [[nodiscard]] virtual const Movement* movement() const { return nullptr; }
    /// Replaces movement(), after replace(), by that of a state. Called only if movement() is not null.
    virtual void resumeMovement(const Movement& /* movement */) {}
    /// Changes a bit of movement(), as Replica::corruptMovement() describes.
    virtual void corruptMovement(int /* column */, int /* row */) {}

    /// Returns the hash of all sand. Hashes again only what has changed since the last call.
    [[nodiscard]] virtual std::uint64_t hash() = 0;
    /// Hashes the next `tiles` hash tiles again from memory, whether or not they have changed.
    virtual void audit(int tiles) = 0;
    /// Returns the hashes of all hash tiles. hash() brings them up to date.
    [[nodiscard]] virtual const HashTiles& hashTiles() const = 0;
    /// Returns the numbers in hash tile `tile`. Comparing those of two replicas shows where the replicas differ.
    [[nodiscard]] virtual std::vector<std::int32_t> valuesOf(int tile) const = 0;
    /// Flips a bit of the sand without updating the hash, as Replica::corrupt() describes.
    virtual void corrupt(int column, int row, int bit) = 0;

    /// Returns the height of the sand at (x, y) [unit]. A height field returns the height of the cell there; a TIN
    /// interpolates within the triangle there. Outside the field, returns the height of the nearest place in it.
    [[nodiscard]] virtual double height(double x, double y /* [probe unit] */) const = 0;
    /// Returns the lowest and the highest height of all sand, except in a TIN's holes. Reads every cell or vertex.
    [[nodiscard]] virtual HeightSpan heights() const = 0;

    /// Returns whether keptHeight() returns heights. A TIN's kept sand is encoded, so that it returns none.
    [[nodiscard]] virtual bool readsKept() const { return false; }
    /// Returns the height at (x, y) as height() does, of the sand that is kept for an undo. Returns nullopt if no sand
    /// is kept, or if readsKept() is false.
    [[nodiscard]] virtual std::optional<double> keptHeight(double /* x */, double /* y */) const {
        return std::nullopt;
    }

    /// Returns references to the current sand. They belong to this surface; call data() again after each change.
    [[nodiscard]] virtual SurfaceData data() const = 0;
    /// Returns the change since the last call; the first call returns a whole change. The surface records changes only
    /// after the first call, so that a replica that is not drawn holds no lists.
    [[nodiscard]] virtual SurfaceChange takeChange() = 0;
};

}  // namespace sand
