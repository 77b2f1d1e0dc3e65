// SPDX-License-Identifier: Apache-2.0
#include "lockstep/session_message.hpp"

#include "lockstep/frame_barrier.hpp"

namespace lockstep {

std::optional<SessionMessage> broadcastSession(const Cluster& cluster,
                                               const std::optional<SessionMessage>& fromMaster) {
    cluster.mayTakeLong(true);
    cluster.awaitBroadcast();
    const base::Bytes bytes = cluster.broadcast(fromMaster ? base::encoded(*fromMaster) : base::Bytes{});
    cluster.mayTakeLong(false);
    if (bytes.empty()) {
        return std::nullopt;
    }
    return base::decoded<SessionMessage>(bytes);
}

std::vector<Readiness> gatherReadiness(const Cluster& cluster, const Readiness& mine) {
    std::vector<Readiness> result;
    for (const base::Bytes& bytes : cluster.gather(base::encoded(mine))) {
        result.push_back(base::decoded<Readiness>(bytes));
    }
    return result;
}

bool agreeToGoOn(const Cluster& cluster, bool master) {
    int goOn = master ? 1 : 0;
    MPI_Bcast(&goOn, 1, MPI_INT, kMaster, cluster.frames());
    return goOn != 0;
}

std::vector<RankReport> gatherReports(FrameBarrier& barrier, const RankReport& mine) {
    const std::vector<base::Bytes> all = barrier.collect(base::encoded(mine));
    std::vector<RankReport> result;
    for (std::size_t rank = 1; rank < all.size(); ++rank) {
        result.push_back(base::decoded<RankReport>(all[rank]));
    }
    return result;
}

}  // namespace lockstep
