// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sand/erosion.hpp"
#include "sand/height_field.hpp"
#include "sand/scene.hpp"
#include "sand/state_hash.hpp"
#include "sand/step.hpp"

namespace sand {

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
    void apply(const Step& step);

    [[nodiscard]] const HeightField& field() const { return field_; }
    [[nodiscard]] const Rules& rules() const { return rules_; }
    [[nodiscard]] const Ground* ground() const { return ground_.get(); }  // null without rock and walls
    [[nodiscard]] const Erosion& erosion() const { return erosion_; }
    [[nodiscard]] std::uint64_t stepNumber() const { return stepNumber_; }
    [[nodiscard]] std::int64_t outflow() const { return outflow_; }  // [unit · cell] lost over an open rim
    [[nodiscard]] ProbePoint probe() const { return probe_; }        // where the tool is
    [[nodiscard]] bool engaged() const { return engaged_; }
    /// Whether no block of sand moves any more: the next sweeps cost nothing.
    [[nodiscard]] bool settled() const { return erosion_.settled(); }

    /// Hash of everything a later step depends on: heights, tool pose, step number, outflow. Of the sand's inertia only
    /// its age: a wrong flux shows in the heights of the next step.
    [[nodiscard]] std::uint64_t stateHash();
    /// Hashes the next `tiles` hash tiles again from memory, changed or not, so that silent corruption shows.
    void audit(int tiles);
    [[nodiscard]] const StateHash& hashTiles() const { return hash_; }

    /// The cells that changed since this was called last: one rectangle around them, empty when nothing did.
    [[nodiscard]] Rect takeDamage();

    /// What a replica of a field of this size takes at the very least, with the scene it starts from [byte].
    [[nodiscard]] static std::int64_t leastBytes(int columns, int rows);

    /// The whole state, for a replica that must start from here (compressed).
    [[nodiscard]] files::Bytes encodeState() const;
    /// Throws files::FormatError when the bytes are no state of this scene; the replica is then unchanged.
    void decodeState(std::span<const std::uint8_t> bytes);

    /// Flips the lowest bit of one cell behind the hash's back: a fault for tests of the lockstep proof.
    void corrupt(int column, int row);

private:
    void touch(const Rect& cells);
    void settleNow();

    Rules rules_;
    std::shared_ptr<const Ground> ground_;
    Erosion::Options options_;
    HeightField field_;
    Erosion erosion_;
    StateHash hash_;
    std::uint64_t stepNumber_ = 0;
    std::int64_t outflow_ = 0;
    ProbePoint probe_;
    bool engaged_ = false;
    Rect damage_;
};

}  // namespace sand
