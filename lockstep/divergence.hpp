// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/field_forms.hpp"
#include "base/names.hpp"
#include "lockstep/frame_barrier.hpp"
#include "sand/replica.hpp"

namespace lockstep {

/// Result of comparing the sand of all ranks: the ranks whose sand is wrong, and the place.
struct Divergence {
    /// A rank whose sand is wrong.
    struct Odd {
        int rank = 0;
        std::uint64_t hash = 0;
        bool onlyMovement = false;  // whether only the movement differs
        int tile = -1;              // first hash tile whose sand differs; -1 if none does
        sand::CellRect cells;       // cells of that tile
        int cellsDiffering = 0;     // in that tile; counted for the first odd rank and for others with the same tile
    };
    /// The source of the right sand.
    enum class Judge : std::uint8_t {
        majority,  // more than half of all ranks have the right hash
        journal,   // no majority, or a wrong one; the journal gave the right sand
        master     // no majority and no usable journal; the master's sand counts as right
    };
    friend constexpr auto valuesOf(Judge) {
        return std::array{base::Named{Judge::majority, "majority"}, base::Named{Judge::journal, "journal"},
                          base::Named{Judge::master, "master"}};
    }
    std::uint64_t rightHash = 0;  // state hash of the right sand
    Judge judge = Judge::majority;
    bool outvoted = false;                   // Arbiter::overrules: the journal has outvoted a majority
    int agreeing = 0;                        // number of ranks with the right hash
    int source = 0;                          // first of these ranks
    std::unique_ptr<sand::Replica> journal;  // the right sand, if no rank has it
    std::vector<Odd> odd;                    // in order of rank
};

/// Hashes of one rank's replica: the state hash, the digest of its movement, and the hash of each hash tile.
struct Account {
    std::uint64_t hash = 0, movement = 0;
    std::vector<std::uint64_t> tiles;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("hash", it.hash);
        visit("movement", it.movement);
        visit("tiles", base::toEnd(it.tiles));
    }
    [[nodiscard]] bool sameSand(const Account& other) const { return hash == other.hash && movement == other.movement; }
};

/// Number of the hash tile whose values all ranks send to the master, or -1.
struct TileRequest {
    std::int32_t tile = -1;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("tile", it.tile);
    }
};

/// Values of one rank in a hash tile, as sand::Replica::valuesOf() gives them.
struct TileValues {
    std::vector<std::int32_t> values;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("values", base::toEnd(it.values));
    }
};

/// Result of counting how many ranks have the same state hash and movement.
struct Vote {
    int rank = 0;      // first rank of the largest group; the master's rank if its group is as large as any other
    int agreeing = 0;  // number of ranks of this group
    bool tie = false;  // whether at most half of all ranks belong to it
};
/// Counts how many ranks have the same state hash and movement.
[[nodiscard]] Vote countVotes(const std::vector<Account>& accounts /* in order of rank, the master's first */);

/// Function that returns the right sand when no hash has a majority, or null if it cannot. If `overrules`, its sand is
/// right although a hash has a majority.
struct Arbiter {
    std::function<std::unique_ptr<sand::Replica>()> sand{};
    bool overrules = false;
};

/// Finds the ranks whose sand is wrong. Call it after a barrier with the verdict Verdict::otherSand. Each rank first
/// computes its hashes again from memory. Returns the result at the master and nullopt on other ranks. Only the
/// master's argument `arbiter` counts. Collective.
[[nodiscard]] std::optional<Divergence> findDivergence(FrameBarrier& barrier, sand::Replica& replica,
                                                       const Arbiter& arbiter = {});

}  // namespace lockstep
