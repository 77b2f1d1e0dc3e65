// SPDX-License-Identifier: Apache-2.0
#include "lockstep/session_message.hpp"

#include <utility>

#include "lockstep/frame_barrier.hpp"

namespace lockstep {

std::optional<SessionMessage> broadcastSession(const Cluster& cluster, SessionMessage* fromMaster,
                                               const std::function<void(double)>& sent) {
    cluster.mayTakeLong(true);
    cluster.awaitBroadcast();
    SessionMessage message;
    base::Bytes scene, rest;  // in the message, the scene would be copied at the master and in each rank
    if (fromMaster != nullptr) {
        message = std::move(*fromMaster);
        scene = std::exchange(message.scene, {});
        rest = base::encoded(message);
    }
    const base::Bytes got = cluster.broadcast(rest);
    if (got.empty() && fromMaster == nullptr) {
        cluster.mayTakeLong(false);
        return std::nullopt;
    }
    base::Bytes gotScene = cluster.broadcast(scene, sent);
    cluster.mayTakeLong(false);
    if (fromMaster != nullptr) {
        return std::nullopt;
    }
    message = base::decoded<SessionMessage>(got);
    message.scene = std::move(gotScene);
    return message;
}

base::Bytes broadcastState(const Cluster& cluster, const base::Bytes& fromMaster,
                           const std::function<void(double)>& sent) {
    cluster.mayTakeLong(true);
    cluster.awaitBroadcast();
    base::Bytes state = cluster.broadcast(fromMaster, sent);
    cluster.mayTakeLong(false);
    return state;
}

std::vector<Readiness> gatherReadiness(const Cluster& cluster, const Readiness& mine,
                                       const std::function<void(double)>& made) {
    std::vector<Readiness> result;
    for (const base::Bytes& bytes : cluster.gatherReady(base::encoded(mine), made)) {
        result.push_back(base::decoded<Readiness>(bytes));
    }
    return result;
}

bool agreeToGoOn(const Cluster& cluster, bool master) { return cluster.agree(master); }

std::vector<RankReport> gatherReports(FrameBarrier& barrier, const RankReport& mine) {
    const std::vector<base::Bytes> all = barrier.collect(base::encoded(mine));
    std::vector<RankReport> result;
    for (std::size_t rank = 1; rank < all.size(); ++rank) {
        result.push_back(base::decoded<RankReport>(all[rank]));
    }
    return result;
}

}  // namespace lockstep
