// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sand/erosion.hpp"
#include "sand/height_field.hpp"
#include "sand/kept_sand.hpp"
#include "sand/scene.hpp"
#include "sand/state_hash.hpp"
#include "sand/step.hpp"
#include "sand/tin/surface_view.hpp"

namespace sand {

/// The whole state of a replica, for whoever compresses it on another thread.
struct StateCopy {
    files::Bytes head;  // all but the sand
    std::optional<SandCopy> beforeStroke;
    SandCopy sand;

    /// What Terrain::decodeState takes (compressed).
    [[nodiscard]] files::Bytes encode() const;
};

/// A replica: the sand, and the one function that changes it.
///
/// Two replicas that start from one scene and apply the same steps are equal bit for bit, whatever the compiler, the
/// number of threads or the size of the blocks. Not thread-safe.
class Terrain {
public:
    /// `options` say how the sand is swept, not what comes of it; their ground is the scene's own.
    explicit Terrain(const Scene& scene, const Erosion::Options& options = {});

    /// The tool displaces sand along the step's path, what an operator asked is done, then Rules::sweepsPerStep sweeps
    /// let the sand slide. Steps must come in order: throws std::logic_error when step.number is not stepNumber() + 1.
    ///
    /// A reset, a load, and an undo that has a stroke to undo, put back heights, outflow and the sand's inertia, and
    /// that step does not sweep: it ends with the sand exactly as it was. Step number, tool and material go on. A load
    /// of bytes that are no sand of this field changes nothing.
    void apply(const Step& step);

    [[nodiscard]] const HeightField& field() const { return field_; }
    [[nodiscard]] const Rules& rules() const { return rules_; }           // now: an operator may have tuned the scene's
    [[nodiscard]] const Ground* ground() const { return ground_.get(); }  // null without rock and walls
    [[nodiscard]] const Erosion& erosion() const { return erosion_; }
    [[nodiscard]] std::uint64_t stepNumber() const { return stepNumber_; }
    [[nodiscard]] std::int64_t outflow() const { return outflow_; }  // [unit · cell] lost over an open rim
    [[nodiscard]] ProbePoint probe() const { return probe_; }        // where the tool is
    [[nodiscard]] double toolRadius() const {                        // [scene unit]
        return rules_.toolRadius * field_.cellSize() / kProbePerCell;
    }
    [[nodiscard]] ToolShape toolShape() const { return rules_.toolShape(); }
    [[nodiscard]] Heading heading() const { return heading_; }  // of the tool, as rules or a hand turned it last
    [[nodiscard]] bool engaged() const { return engaged_; }
    /// Whether an undo would change anything. A stroke is the steps in which the tool touches, from the first after one
    /// in which it hovered; only the last is kept, until an undo, a reset or a load.
    [[nodiscard]] bool canUndo() const { return beforeStroke_.kept() != nullptr; }
    /// Whether no block of sand moves any more: the next sweeps cost nothing.
    [[nodiscard]] bool settled() const { return erosion_.settled(); }

    /// Hash of everything a later step depends on: heights, tool pose, step number, outflow, and tool
    /// and material where they are not the scene's. Of the sand's inertia only
    /// its age: a wrong flux shows in the heights of the next step, and a wrong undo in those after it.
    [[nodiscard]] std::uint64_t stateHash();
    /// Hashes the next `tiles` hash tiles again from memory, changed or not, so that silent corruption shows.
    void audit(int tiles);
    [[nodiscard]] const StateHash& hashTiles() const { return hash_; }

    /// The cells that changed since this was called last: one rectangle around them, empty when nothing did.
    [[nodiscard]] Rect takeDamage();

    /// The surface of a scene whose terrain is a TIN, null on a grid; field() and takeDamage() are then not for use.
    [[nodiscard]] const tin::SurfaceView* tinView() const { return nullptr; }
    [[nodiscard]] tin::SurfaceDamage takeTinDamage() { return {}; }

    /// What a replica of a field of this size takes at the very least, with the scene it starts from [byte].
    [[nodiscard]] static std::int64_t leastBytes(int columns, int rows);

    /// The sand now, for whoever compresses it on another thread.
    [[nodiscard]] SandCopy copySand() const { return {field_, erosion_.inertia(), outflow_}; }
    [[nodiscard]] StateCopy copyState() const;
    /// The whole state, for a replica that must start from here (compressed).
    [[nodiscard]] files::Bytes encodeState() const { return copyState().encode(); }
    /// Throws files::FormatError when the bytes are no state of this scene; the replica is then unchanged.
    void decodeState(std::span<const std::uint8_t> bytes);

    /// Flips one bit of one cell's height behind the hash's back, the lowest being 0: a fault for tests and drills of
    /// the lockstep proof.
    void corrupt(int column, int row, int bit = 0);

private:
    void touch(const Rect& cells);
    void settleNow();
    void tune(const Tuning& tuning);
    /// The tool goes on from where it is, or stays and presses.
    void drag(const Tool& tool, const ProbePoint& from, const ProbePoint& to);
    /// Does reset, undo or load; false when there was nothing to do.
    bool putBack(const Edit& edit);
    void replaceSand(const SandCopy& sand);

    Rules rules_, sceneRules_;
    std::shared_ptr<const Ground> ground_;
    Erosion::Options options_;
    HeightField field_;
    Erosion erosion_;
    StateHash hash_;
    std::uint64_t stepNumber_ = 0;
    std::int64_t outflow_ = 0;
    ProbePoint probe_;
    Heading heading_;
    bool engaged_ = false;
    std::shared_ptr<const files::Bytes> start_;  // the scene's heights, compressed; copies of a replica share them
    KeptSand beforeStroke_;                      // the last one
    Rect damage_;
};

}  // namespace sand
