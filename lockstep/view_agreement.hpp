// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lockstep/frame_barrier.hpp"
#include "lockstep/frame_message.hpp"

namespace lockstep {

/// What a rank shows its frame by: the display as it has decoded it, and the view of one frame. Ranks that differ in it
/// would draw tiles that do not join, over sand that is equal.
class ViewProof {
public:
    /// `wall` is Wall::encode() of the wall that this rank holds, not the bytes it was sent.
    explicit ViewProof(std::span<const std::uint8_t> wall);
    [[nodiscard]] std::uint64_t hash(const ViewState& view) const;

private:
    std::uint64_t wall_;
};

/// At the master: a line for every rank that came to the barrier with another view than the master's. `names` are those
/// of the barrier.
[[nodiscard]] std::vector<std::string> describeOtherViews(const std::vector<Arrival>& arrivals,
                                                          const std::vector<std::string>& names);

}  // namespace lockstep
