// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lockstep/frame_barrier.hpp"
#include "sand/replica.hpp"

namespace lockstep {

/// Who holds other sand than is right, and where.
struct Divergence {
    struct Odd {
        int rank = 0;
        std::uint64_t hash = 0;
        int tile = -1;           // first differing hash tile; -1 when only pose, step or outflow differ
        sand::CellRect cells;    // of that tile
        int cellsDiffering = 0;  // in that tile; of the first odd rank, and others that differ in the same
    };
    enum class Judge : std::uint8_t {
        majority,  // more ranks have the right hash than any other
        journal,   // none has a majority, and the journal says which is right
        master     // none has, there is no journal, and the master's was taken
    };
    std::uint64_t rightHash = 0;
    Judge judge = Judge::majority;
    int agreeing = 0;                        // ranks with that hash
    int source = 0;                          // the first of them
    std::unique_ptr<sand::Replica> journal;  // the right sand, where no rank has it
    std::vector<Odd> odd;                    // by rank
};

/// What each rank has: a replica's hash, and that of each of its hash tiles.
struct Account {
    std::uint64_t hash = 0;
    std::vector<std::uint64_t> tiles;
};

/// How the ranks' hashes divide.
struct Vote {
    std::uint64_t hash = 0;  // that most ranks have; on a tie one of these, the master's where it is among them
    int agreeing = 0;        // ranks with it
    bool tie = false;        // as many have another one
};
[[nodiscard]] Vote countVotes(const std::vector<Account>& accounts /* by rank, the master's first */);

/// The right sand where no hash has a majority; nothing where nobody can tell.
using Arbiter = std::function<std::unique_ptr<sand::Replica>()>;

/// Collective, after a barrier whose hashes differed: finds the odd ranks, by hashes computed afresh from memory. The
/// master, who alone gives an arbiter, gets the answer, others nothing.
[[nodiscard]] std::optional<Divergence> findDivergence(FrameBarrier& barrier, sand::Replica& terrain,
                                                       const Arbiter& arbiter = {});

}  // namespace lockstep
