// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lockstep/fault.hpp"
#include "master/steps/step_source.hpp"
#include "sand/replica.hpp"

namespace master {

/// The master's own replica of the sand, its state hash, and the faults that drills inject into it. One thread.
class MasterSand {
public:
    /// `options` say how the sand is swept; `faults` are those of all ranks. A resumed session gives the `state` to go
    /// on with and the edits so far. Throws base::FormatError when that is no state of this sand.
    MasterSand(const sand::Start& start, const sand::grid::Erosion::Options& options,
               const std::vector<lockstep::Fault>& faults, std::span<const std::uint8_t> state = {},
               std::uint64_t edits = 0);

    [[nodiscard]] const sand::Replica& replica() const { return replica_; }
    /// For healing; rehash() afterwards.
    [[nodiscard]] sand::Replica& replica() { return replica_; }
    /// Returns the hash of the state that the wall shows once all ranks have agreed.
    [[nodiscard]] std::uint64_t hash() const { return hash_; }
    void rehash() { hash_ = replica_.stateHash(); }

    /// Injects what drills want in this frame, applies its steps, and hashes `auditTiles` hash tiles again from memory.
    /// Tells `source` of each new state.
    void apply(std::uint64_t frame, const std::vector<haptic_bridge::TimedStep>& steps, std::uint32_t auditTiles,
               StepSource& source);
    /// Returns how many hash tiles to hash again in a frame, so that all of memory has its turn in a second, whatever
    /// the frame rate. `sinceSwap` is how long the frame before took [s].
    [[nodiscard]] std::uint32_t auditTiles(double sinceSwap) const;

    /// Steps with an edit since the session's beginning.
    [[nodiscard]] std::uint64_t edits() const { return edits_; }

private:
    sand::Replica replica_;
    const lockstep::FaultsOfRank faults_;
    std::uint64_t hash_ = 0;
    std::uint64_t edits_ = 0;
};

}  // namespace master
