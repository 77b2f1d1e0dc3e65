// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lockstep/frame_barrier.hpp"
#include "lockstep/frame_message.hpp"

namespace lockstep {

/// Hash over everything that a rank draws its frame by: the wall as the rank has decoded it, and the view of one frame.
/// Ranks with different hashes draw tiles that do not join, even if their sand is equal.
class ViewProof {
public:
    /// `wall` is Wall::encode() of the wall that this rank has decoded, not the bytes that it received.
    explicit ViewProof(std::span<const std::uint8_t> wall);
    [[nodiscard]] std::uint64_t hash(const ViewState& view) const;

private:
    std::uint64_t wall_;
};

/// Returns a line for each rank whose view at the barrier differs from the master's. `names` are the names of the ranks
/// in messages, in order of rank. Used at the master.
[[nodiscard]] std::vector<std::string> describeOtherViews(const std::vector<Arrival>& arrivals,
                                                          const std::vector<std::string>& names);

}  // namespace lockstep
