// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lockstep/cluster.hpp"
#include "sand/terrain.hpp"

namespace lockstep {

/// Who holds other sand than the rest, and where.
struct Divergence {
    struct Odd {
        int rank = 0;
        std::uint64_t hash = 0;
        int tile = -1;           // first differing hash tile; -1 when only pose, step or outflow differ
        sand::Rect cells;        // of that tile
        int cellsDiffering = 0;  // in that tile, against a rank of the majority
    };
    std::uint64_t majorityHash = 0;
    int agreeing = 0;      // ranks with that hash, the master among them
    bool tie = false;      // no hash has more ranks than every other: the master's was taken
    std::vector<Odd> odd;  // by rank
};

/// Collective, after a barrier whose hashes differed: finds the odd ranks. The master gets the answer, others nothing.
[[nodiscard]] std::optional<Divergence> findDivergence(const Cluster& cluster, sand::Terrain& terrain);

}  // namespace lockstep
