// SPDX-License-Identifier: Apache-2.0
#include "lockstep/divergence.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace lockstep {
namespace {

Account accountOf(sand::Replica& replica) {
    const std::uint64_t hash = replica.stateHash();  // brings the hashes of the tiles up to date
    return {hash, replica.movementDigest(), replica.hashTiles().tileHashes()};
}

std::vector<Account> collectAccounts(FrameBarrier& barrier, sand::Replica& replica) {
    std::vector<Account> accounts;
    for (const base::Bytes& bytes : barrier.collect(base::encoded(accountOf(replica)))) {
        accounts.push_back(base::decoded<Account>(bytes));
    }
    return accounts;
}

std::vector<std::int32_t> heightsOf(const sand::Replica& replica, int tile) {
    return tile >= 0 ? replica.valuesOf(tile) : std::vector<std::int32_t>();
}

/// Returns the values in hash tile `tile` of all ranks at the master, in order of rank.
std::vector<std::vector<std::int32_t>> collectHeights(FrameBarrier& barrier, const sand::Replica& replica, int tile) {
    std::vector<std::vector<std::int32_t>> all;
    for (const base::Bytes& bytes : barrier.collect(base::encoded(TileValues{heightsOf(replica, tile)}))) {
        all.push_back(base::decoded<TileValues>(bytes).values);
    }
    return all;
}

/// Decides at the master which hash is right, and fills in `result`. Returns the hashes of the right sand.
Account judge(const std::vector<Account>& accounts, const Arbiter& arbiter, Divergence& result) {
    const Vote vote = countVotes(accounts);
    Account right = accounts[static_cast<std::size_t>(vote.rank)];
    if (vote.tie || arbiter.overrules) {
        result.outvoted = arbiter.overrules;
        result.journal = arbiter.sand ? arbiter.sand() : nullptr;
        result.judge = result.journal ? Divergence::Judge::journal : Divergence::Judge::master;
        right = result.journal ? accountOf(*result.journal) : accounts[kMaster];
    }
    result.rightHash = right.hash;
    const auto isRight = [&](const Account& account) { return account.sameSand(right); };
    result.agreeing = static_cast<int>(std::ranges::count_if(accounts, isRight));
    if (result.agreeing > 0) {
        result.journal.reset();  // a rank holds the right sand
        result.source = static_cast<int>(std::ranges::find_if(accounts, isRight) - accounts.begin());
    }
    return right;
}

}  // namespace

Vote countVotes(const std::vector<Account>& accounts) {
    std::map<std::pair<std::uint64_t, std::uint64_t>, int> votes;
    for (const Account& account : accounts) {
        ++votes[{account.hash, account.movement}];
    }
    Vote result;
    for (std::size_t rank = 0; rank < accounts.size(); ++rank) {  // the master first
        if (const int count = votes[{accounts[rank].hash, accounts[rank].movement}]; count > result.agreeing) {
            result.rank = static_cast<int>(rank);
            result.agreeing = count;
        }
    }
    // Two ranks with the same error can outnumber every other hash, so only more than half of all ranks is a majority.
    result.tie = 2 * result.agreeing <= static_cast<int>(accounts.size());
    return result;
}

std::optional<Divergence> findDivergence(FrameBarrier& barrier, sand::Replica& replica, const Arbiter& arbiter) {
    replica.audit(replica.hashTiles().tileCount());
    const std::vector<Account> accounts = collectAccounts(barrier, replica);
    Divergence result;
    if (barrier.cluster().isMaster()) {
        const Account right = judge(accounts, arbiter, result);
        for (std::size_t rank = 0; rank < accounts.size(); ++rank) {
            if (!accounts[rank].sameSand(right)) {
                const auto& mine = accounts[rank].tiles;
                const auto differing = std::mismatch(mine.begin(), mine.end(), right.tiles.begin()).first;
                Divergence::Odd& odd = result.odd.emplace_back();
                odd.rank = static_cast<int>(rank);
                odd.hash = accounts[rank].hash;
                odd.onlyMovement = odd.hash == right.hash;
                odd.tile = differing == mine.end() ? -1 : static_cast<int>(std::distance(mine.begin(), differing));
            }
        }
    }
    // Collects the values of the first odd rank's tile from all ranks. One wrong value suggests a bit flip, many
    // suggest a bug.
    const TileRequest request{result.odd.empty() ? -1 : result.odd.front().tile};
    const int tile = base::decoded<TileRequest>(barrier.broadcast(base::encoded(request))).tile;
    const auto heights = collectHeights(barrier, replica, tile);
    if (!barrier.cluster().isMaster()) {
        return std::nullopt;
    }
    const auto right =
        result.journal ? heightsOf(*result.journal, tile) : heights[static_cast<std::size_t>(result.source)];
    for (Divergence::Odd& odd : result.odd) {
        if (odd.tile < 0) {
            continue;
        }
        odd.cells = replica.hashTiles().cellsOf(odd.tile);
        const auto& wrong = heights[static_cast<std::size_t>(odd.rank)];
        for (std::size_t i = 0; odd.tile == tile && i < wrong.size(); ++i) {
            odd.cellsDiffering += wrong[i] == right[i] ? 0 : 1;
        }
    }
    return result;
}

}  // namespace lockstep
