// SPDX-License-Identifier: Apache-2.0
#include "lockstep/session_message.hpp"

#include "lockstep/frame_barrier.hpp"

namespace lockstep {
namespace {

/// Returns the bytes of a message. Takes the memory for them at once: the scene and the state may have gigabytes.
base::Bytes encodedOnce(const SessionMessage& message) {
    constexpr std::size_t kRest = 1 << 16;  // [byte], a usual size of the other fields
    base::ByteWriter writer;
    writer.reserve(message.scene.size() + message.state.size() + message.wall.size() + kRest);
    base::putMember(writer, message);
    return writer.take();
}

}  // namespace

std::optional<SessionMessage> broadcastSession(const Cluster& cluster, const SessionMessage* fromMaster,
                                               const std::function<void(double)>& sent) {
    cluster.mayTakeLong(true);
    cluster.awaitBroadcast();
    const base::Bytes bytes = cluster.broadcast(fromMaster != nullptr ? encodedOnce(*fromMaster) : base::Bytes{}, sent);
    cluster.mayTakeLong(false);
    if (bytes.empty()) {
        return std::nullopt;
    }
    return base::decoded<SessionMessage>(bytes);
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
