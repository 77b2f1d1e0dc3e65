// SPDX-License-Identifier: Apache-2.0
#include "lockstep/divergence.hpp"

#include <algorithm>
#include <map>

namespace lockstep {
namespace {

struct Account {
    std::uint64_t hash = 0;
    std::vector<std::uint64_t> tiles;
};

std::vector<Account> gatherAccounts(const Cluster& cluster, sand::Terrain& terrain) {
    files::ByteWriter writer;
    writer.put(terrain.stateHash());
    for (const std::uint64_t tile : terrain.hashTiles().tileHashes()) {
        writer.put(tile);
    }
    std::vector<Account> accounts;
    for (const files::Bytes& bytes : cluster.gather(writer.take())) {
        files::ByteReader reader(bytes);
        Account& account = accounts.emplace_back();
        account.hash = reader.get<std::uint64_t>();
        while (!reader.atEnd()) {
            account.tiles.push_back(reader.get<std::uint64_t>());
        }
    }
    return accounts;
}

/// The heights of one tile of every rank, by rank.
std::vector<files::Bytes> gatherTile(const Cluster& cluster, const sand::Terrain& terrain, int tile) {
    files::ByteWriter writer;
    if (tile >= 0) {
        const sand::Rect cells = terrain.hashTiles().cellsOf(tile);
        for (int y = cells.y0; y < cells.y1; ++y) {
            for (int x = cells.x0; x < cells.x1; ++x) {
                writer.put(terrain.field().height(x, y));
            }
        }
    }
    return cluster.gather(writer.take());
}

/// Sets the hash that most ranks have; on a tie the master's if it is among the first, else the smallest.
void findMajority(const std::vector<Account>& accounts, Divergence& result) {
    std::map<std::uint64_t, int> votes;
    for (const Account& account : accounts) {
        ++votes[account.hash];
    }
    for (const auto& [hash, count] : votes) {
        if (count > result.agreeing || (count == result.agreeing && hash == accounts[kMaster].hash)) {
            result.majorityHash = hash;
            result.agreeing = count;
        }
    }
    result.tie =
        std::count_if(votes.begin(), votes.end(), [&](const auto& vote) { return vote.second == result.agreeing; }) > 1;
}

}  // namespace

std::optional<Divergence> findDivergence(const Cluster& cluster, sand::Terrain& terrain) {
    const std::vector<Account> accounts = gatherAccounts(cluster, terrain);
    Divergence result;
    std::size_t right = 0;
    if (cluster.isMaster()) {
        findMajority(accounts, result);
        while (accounts[right].hash != result.majorityHash) {
            ++right;
        }
        for (std::size_t rank = 0; rank < accounts.size(); ++rank) {
            if (accounts[rank].hash != result.majorityHash) {
                const auto& mine = accounts[rank].tiles;
                const auto differing = std::mismatch(mine.begin(), mine.end(), accounts[right].tiles.begin()).first;
                Divergence::Odd& odd = result.odd.emplace_back();
                odd.rank = static_cast<int>(rank);
                odd.hash = accounts[rank].hash;
                odd.tile = differing == mine.end() ? -1 : static_cast<int>(std::distance(mine.begin(), differing));
            }
        }
    }
    // The cells of the first odd rank's tile, from everyone: how much differs says bit flip or bug.
    int tile = result.odd.empty() ? -1 : result.odd.front().tile;
    MPI_Bcast(&tile, 1, MPI_INT, kMaster, cluster.frames());
    const std::vector<files::Bytes> heights = gatherTile(cluster, terrain, tile);
    if (!cluster.isMaster()) {
        return std::nullopt;
    }
    for (Divergence::Odd& odd : result.odd) {
        if (odd.tile < 0) {
            continue;
        }
        odd.cells = terrain.hashTiles().cellsOf(odd.tile);
        const auto& wrong = heights[static_cast<std::size_t>(odd.rank)];
        for (std::size_t i = 0; odd.tile == tile && i < wrong.size(); i += sizeof(std::int32_t)) {
            odd.cellsDiffering += std::equal(&wrong[i], &wrong[i] + sizeof(std::int32_t), &heights[right][i]) ? 0 : 1;
        }
    }
    return result;
}

}  // namespace lockstep
