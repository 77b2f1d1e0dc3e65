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
    // In the message, scene and state would be copied at the master and in each rank.
    base::Bytes scene, state, rest;
    if (fromMaster != nullptr) {
        message = std::move(*fromMaster);
        scene = std::exchange(message.scene, {});
        state = std::exchange(message.state, {});
        rest = base::encoded(message);
    }
    const auto whole = static_cast<double>(scene.size() + state.size());
    const auto part = [&](const base::Bytes& bytes, double before) -> std::function<void(double)> {
        if (!sent || whole == 0) {
            return {};
        }
        return [&sent, whole, before, own = static_cast<double>(bytes.size())](double share) {
            sent((before + share * own) / whole);
        };
    };
    const base::Bytes got = cluster.broadcast(rest);
    if (got.empty() && fromMaster == nullptr) {
        cluster.mayTakeLong(false);
        return std::nullopt;
    }
    base::Bytes gotScene = cluster.broadcast(scene, part(scene, 0));
    base::Bytes gotState = cluster.broadcast(state, part(state, static_cast<double>(scene.size())));
    cluster.mayTakeLong(false);
    if (fromMaster != nullptr) {
        return std::nullopt;
    }
    message = base::decoded<SessionMessage>(got);
    message.scene = std::move(gotScene);
    message.state = std::move(gotState);
    return message;
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
