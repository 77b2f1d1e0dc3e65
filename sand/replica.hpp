// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/executor.hpp"
#include "sand/model/step.hpp"
#include "sand/model/surface.hpp"
#include "sand/start.hpp"

namespace sand {

/// Version of the bytes that Replica::encodeState() writes. Replica::decodeState() refuses every other version.
inline constexpr std::uint32_t kStateVersion = 10;
/// Version of what the state hash covers, which is part of the hash.
inline constexpr std::uint32_t kHashVersion = 9;

/// All state of a replica except its sand.
struct StateHead {
    std::uint64_t number = 0;  // of the last step
    ProbePoint probe;
    Heading heading;
    bool engaged = false;
    Owed owed;
    Tuning tuning;

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("state version", base::constant(kStateVersion, "that of this release"));
        members(it, visit);
    }
    /// Visits all members that the state hash covers: all but the version.
    template <class Self, class Visit>
    static void members(Self& it, Visit& visit) {
        constexpr std::uint64_t kMostSteps = std::uint64_t{1} << 62;  // so that the number of a step never overflows
        visit("step", base::limited(it.number, 0, kMostSteps));
        for (auto* coordinate : {&it.probe.x, &it.probe.y, &it.probe.z}) {
            visit("probe", base::limited(*coordinate, -kMaxProbe, kMaxProbe));
        }
        visit("heading", it.heading);
        visit("engaged", it.engaged);
        visit("owed", it.owed);
        visit("tuning", it.tuning);
    }
};

/// Copy of a replica's whole state. Another thread can compress it while the replica applies further steps.
struct StateCopy {
    base::Bytes head;                                 // of StateHead
    base::Bytes movement;                             // of Movement; empty for a TIN
    std::shared_ptr<const SurfaceCopy> beforeStroke;  // sand that an undo restores; null if there is none
    std::shared_ptr<const SurfaceCopy> sand;

    /// Writes the state as compressed bytes for Replica::decodeState(). Calls `between` as SurfaceCopy::encodeInto()
    /// does. Requires complete().
    void encodeInto(base::ByteWriter& writer, const std::function<void()>& between = {}) const;
    /// Returns what encodeInto() writes.
    [[nodiscard]] base::Bytes encode(const std::function<void()>& between = {}) const;
    /// Returns how often encodeInto() calls `between`. Requires complete().
    [[nodiscard]] std::size_t stripes() const {
        return sand->stripes() + (beforeStroke == nullptr ? 0 : beforeStroke->stripes());
    }
    /// Returns whether the copy has all sand. Call it in the thread of the replica.
    [[nodiscard]] bool complete() const {
        return sand->complete() && (beforeStroke == nullptr || beforeStroke->complete());
    }
};

/// One program's copy of the sand, and apply(), the function through which each step changes it.
///
/// Replicas that begin with the same Start and apply the same steps are equal bit for bit. Compiler, number of threads
/// and block size make no difference. Constructors, apply() and decodeState() set the calling thread to compute with
/// floats as the sand needs it (base/float_environment.hpp), and leave it so. Not thread-safe.
class Replica {
public:
    /// Creates the sand of `start`. `executor` shares out the work of its sweeps, and must outlive the replica. If it
    /// is null, the calling thread does all work. A TIN does not use it.
    explicit Replica(const Start& start, const base::Executor* executor = nullptr);
    /// Creates the same, and takes the heights of `start` (Start::takeHeights()). A large field is then in memory once.
    [[nodiscard]] static Replica takingHeightsOf(Start& start, const base::Executor* executor = nullptr);
    /// Takes `surface` as the sand of `start`. It must have been made from `start`, and may be swept in any way that
    /// gives the same sand.
    Replica(const Start& start, std::unique_ptr<Surface> surface);
    Replica(const Replica& other);
    Replica& operator=(const Replica& other);
    Replica(Replica&&) noexcept = default;
    Replica& operator=(Replica&&) noexcept = default;
    ~Replica() = default;

    /// Applies the next step. An engaged tool displaces sand along step.path, then step.edit is done. Then the sand
    /// slides for step.sweeps of the owed sweeps. Throws std::logic_error if step.number is not stepNumber() + 1.
    ///
    /// docs/how_it_works.md#a-step has the rules of owed sweeps and of edits. docs/journal.md says which steps are left
    /// out, as a whole or in part; all replicas leave out the same. After std::bad_alloc, which depends on the host,
    /// the replica is unusable, and its process must end.
    void apply(const Step& step) {
        apply(step, [](StepPart) {});
    }
    /// Applies the next step. Calls `ended` at the end of each part of it, so that the caller can measure the parts and
    /// the sweeps. It is not called for a step that is left out or that restores sand.
    void apply(const Step& step, const std::function<void(StepPart)>& ended);
    /// Returns why apply() would leave out the whole of `step`, the next step, because of the owed sweeps, or an empty
    /// text.
    [[nodiscard]] std::string whyRefused(const Step& step) const;
    /// Returns the work of the last step that was applied. The number of sweeps may differ between equal replicas.
    [[nodiscard]] const StepWork& lastWork() const { return lastWork_; }
    /// Returns one line about what the last apply() has left out: an ignored load, an ignored path, or the whole step.
    /// Returns an empty text if it has done the whole step. An ignored undo does not count.
    [[nodiscard]] const std::string& leftOut() const { return leftOut_; }
    /// Returns whether the last apply() has left out the whole step because of the owed sweeps.
    [[nodiscard]] bool refusedStep() const { return refusedStep_; }

    /// Returns whether a press in the last apply() was refused.
    [[nodiscard]] bool refusedPress() const { return refusedPress_; }
    /// Returns the first press that was refused since the replica was made, or nullopt.
    [[nodiscard]] const std::optional<RefusedPress>& firstRefusedPress() const {
        return surface_->refusedPresses().first;
    }

    /// Returns the sweeps of the last step that are still to be paid. On a TIN only a settle owes any.
    [[nodiscard]] const Owed& owed() const { return owed_; }
    /// Returns whether the tool must stay where it is, because sweeps are owed. A settle does not hold the tool.
    [[nodiscard]] bool holdsTool() const { return owed_.any() && !owed_.untilRest(); }
    /// Returns the most sweeps that the next step may run if it is `step`; 0 for a TIN, whose steps state no sweeps.
    /// `step` need not have its sweeps yet.
    [[nodiscard]] std::int32_t mostSweeps(const Step& step) const;
    /// Returns the sweeps with which `step` pays all that is owed, but of a settle only settlingSweeps(); 0 for a TIN.
    [[nodiscard]] std::int32_t wholeSweeps(const Step& step) const;
    /// Returns whether the next step has a coarse phase if it is `step`. Assumes that an undo, reset or load has no
    /// effect.
    [[nodiscard]] bool hasCoarsePhase(const Step& step) const;

    [[nodiscard]] const Rules& rules() const { return rules_; }  // the scene's, with the operator's tuning
    [[nodiscard]] const Surface& surface() const { return *surface_; }
    [[nodiscard]] double cellSize() const { return cellSize_; }  // [scene unit], nominal for a TIN
    [[nodiscard]] std::uint64_t stepNumber() const { return stepNumber_; }
    /// Returns the volume that left the field over an open rim [unit · cell; for a TIN: unit · probe unit² / 6].
    [[nodiscard]] std::int64_t outflow() const { return surface_->outflow(); }
    /// Returns the exact volume of all sand [unit · cell; for a TIN: unit · probe unit² / 6].
    [[nodiscard]] std::int64_t volume() const { return surface_->volume(); }
    [[nodiscard]] ProbePoint probe() const { return probe_; }  // the tool's centre [probe unit]
    [[nodiscard]] double toolRadius() const {                  // [scene unit]
        return rules_.tuning.tool.radius * cellSize_ / kProbePerCell;
    }
    /// Returns the tool of the rules, with the heading that a hand may have given it.
    [[nodiscard]] Tool tool() const { return rules_.tuning.tool.turnedTo(heading_); }
    [[nodiscard]] Heading heading() const { return heading_; }
    [[nodiscard]] bool engaged() const { return engaged_; }  // whether the tool may touch the sand
    /// Returns whether an undo can restore sand. The replica keeps the sand from before the last stroke. A stroke
    /// begins with the first step in which the tool is engaged after it hovered. After an undo, a reset or a load, the
    /// replica keeps no sand. If the tool is still engaged, it keeps the restored sand: a stroke begins there.
    [[nodiscard]] bool canUndo() const { return surface_->hasKept(); }
    /// Returns whether sweeps have found all sand at rest. The next sweeps then visit no block of a height field and no
    /// edge of a TIN. Returns false before the first sweep, even if the sand is at rest.
    [[nodiscard]] bool settled() const { return surface_->settled(); }
    /// Returns whether the last step has changed its number alone, and the next one would do the same. A step that
    /// moves the tool or has an edit may change more. Only steps without a path, a heading or an edit may be left out
    /// then.
    [[nodiscard]] bool atRest() const { return surface_->atRest() && !owed_.any() && lastWork_ == StepWork{}; }
    /// Returns whether a settle continues in the next step.
    [[nodiscard]] bool settling() const { return owed_.untilRest(); }
    /// Returns whether `step` has a settle that lets the sand settle by sweeps.
    [[nodiscard]] bool settlesBySweeps(const Step& step) const {
        return step.edit.kind == Edit::settle && (step.engaged || surface_->settlesBySweeps());
    }
    /// Returns whether a settle by sweeps has come to rest in the last apply().
    [[nodiscard]] bool settleCameToRest() const { return settleCameToRest_; }
    /// Returns the number of sweeps of a settle in a step without Step::sweeps, unless the rules ask for more.
    [[nodiscard]] int settlingSweeps() const;

    /// Returns the state hash. It covers the sand, outflow, probe, heading, step number, whether the tool is engaged,
    /// what is owed, and the rules that an operator has tuned. It covers the age of the inertia but not
    /// its fluxes, because a wrong flux shows in the heights after the next step. It does not cover the sand that is
    /// kept for an undo, because wrong sand shows after the undo.
    [[nodiscard]] std::uint64_t stateHash();
    /// Hashes the next `tiles` hash tiles again from memory, whether or not they have changed. Corrupted memory then
    /// changes stateHash().
    void audit(int tiles) { surface_->audit(tiles); }
    /// Returns the digest of Surface::movement(), computed from memory; 0 for a TIN. The state hash does not cover it.
    [[nodiscard]] std::uint64_t movementDigest() const;
    /// Returns the hashes of all hash tiles. stateHash() brings them up to date.
    [[nodiscard]] const HashTiles& hashTiles() const { return surface_->hashTiles(); }
    /// Returns the numbers in hash tile `tile`. Comparing those of two replicas shows where the replicas differ.
    [[nodiscard]] std::vector<std::int32_t> valuesOf(int tile) const { return surface_->valuesOf(tile); }

    /// Returns the change of surface() since the last call. The first call returns a whole change.
    [[nodiscard]] SurfaceChange takeChange() { return surface_->takeChange(); }

    /// Returns a copy of the current sand. Another thread can compress it with SurfaceCopy::encode().
    [[nodiscard]] std::shared_ptr<const SurfaceCopy> copySand() const { return surface_->copy(); }
    /// Returns the function that decodes sand for this field. It stays valid after the replica is gone.
    [[nodiscard]] SurfaceReader sandReader() const { return surface_->reader(); }
    /// Returns a copy of the whole state.
    [[nodiscard]] StateCopy copyState() const;
    /// Begins a copy of the whole state of this moment, which takes no longer for a large field. Steps copy the sand
    /// that they change, and continueCopy() copies the other sand. Another thread may have the copy when it is
    /// complete. The replica completes all copies that their owners still hold.
    [[nodiscard]] StateCopy beginCopy() const;
    /// Copies at least `cells` further cells of the oldest begun copy, or all that it lacks. Returns false if no begun
    /// copy lacks any. A copy of this replica, or another one in its place, has begun none.
    bool continueCopy(std::int64_t cells) const { return surface_->continueCopy(cells); }
    /// Returns what makes records of the sand. The state does not contain them. decodeState() follows no record
    /// further, because the sand before it may have been wrong.
    [[nodiscard]] SurfaceRecorder& recorder() { return *surface_; }
    /// Returns the whole state as compressed bytes, from which another replica can continue.
    /// Takes `expected` bytes of memory at once, so that a large state is not copied while it grows.
    [[nodiscard]] base::Bytes encodeState(std::size_t expected = 0) const;
    /// Replaces the whole state by what encodeState() wrote. Throws base::FormatError if the bytes are not a state of
    /// kStateVersion for this field; the replica is then unchanged. The memory that it allocates is bounded by the
    /// scene and by the length of the bytes. After std::bad_alloc, call decodeState() again before other functions.
    /// Calls `decoded` again and again, unless it is empty, with the number of bytes that it has decoded since the last
    /// call: about all of them together. A state of a TIN is decoded without a call.
    void decodeState(std::span<const std::uint8_t> bytes, const std::function<void(std::size_t)>& decoded = {}) {
        takeState(bytes, {decoded, false});
    }
    /// Does the same, but may leave any sand in the replica if it throws base::FormatError. A height field then has no
    /// second copy of its heights in memory meanwhile.
    void decodeStateInPlace(std::span<const std::uint8_t> bytes, const std::function<void(std::size_t)>& decoded = {}) {
        takeState(bytes, {decoded, true});
    }

    /// Flips bit `bit` (0 is the lowest) of one cell's height, or of the volume of a TIN's vertex in that cell's
    /// triangle. The hash is not updated. Tests and drills inject this fault to prove that a divergence is found.
    void corrupt(int column, int row, int bit = 0) { surface_->corrupt(column, row, bit); }
    /// Flips the lowest bit of the step that has last moved the sand of one cell's hash tile. Has no effect on a TIN.
    /// Drills inject this fault.
    void corruptMovement(int column, int row) { surface_->corruptMovement(column, row); }

private:
    /// Values that a step changes along with the sand.
    struct ToolState {
        Tuning tuning;
        ProbePoint probe;
        Heading heading;
    };
    [[nodiscard]] StateHead head() const;
    [[nodiscard]] base::Bytes encodedMovement() const;
    void takeState(std::span<const std::uint8_t> bytes, const Surface::Decoding& how);
    /// Returns whether `step` moves a tool that is in the sand before the step or after it.
    [[nodiscard]] bool movesTool(const Step& step) const;
    /// Returns whether `step` moves a tool that is in the sand, or gives it another shape.
    [[nodiscard]] bool displacesSand(const Step& step) const;
    /// Returns the sweeps that are owed when `step` has begun, before it runs any. Assumes that an undo, reset or load
    /// has no effect.
    [[nodiscard]] Owed owedBy(const Step& step) const;
    /// Returns the sweeps in which a step without Step::sweeps pays `owed`.
    [[nodiscard]] std::int32_t wholeOf(const Owed& owed) const;
    void tune(const Tuning& tuning);
    /// Displaces the sand below the tool at its current position.
    void press();
    void applyToSand(const Step& step, const std::function<void(StepPart)>& ended);
    /// Ends a step whose application has failed. `before` is from before the step.
    void skip(const Step& step, const ToolState& before, const char* why);
    /// Restores the sand that is kept for an undo. Returns false if no sand is kept, or if it is not possible sand.
    bool restoreKept();
    /// Does a reset, an undo or a load. Returns false if the edit restores no sand.
    bool putBack(const Edit& edit);

    Rules rules_;
    double cellSize_;
    std::unique_ptr<Surface> surface_;
    std::uint64_t stepNumber_ = 0;
    ProbePoint probe_;
    Heading heading_;
    bool engaged_ = false;
    Owed owed_;
    std::string leftOut_;
    bool refusedStep_ = false, refusedPress_ = false, settleCameToRest_ = false;  // by the last apply()
    StepWork lastWork_;
};

}  // namespace sand
