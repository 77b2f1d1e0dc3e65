// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lockstep/cluster.hpp"
#include "lockstep/fault.hpp"
#include "scene/scene.hpp"

namespace lockstep {

class FrameBarrier;

/// What every rank is told before the first frame. Ranks read no file: the scene and the wall come from the master.
struct SessionMessage {
    base::Bytes scene;            // scene::Scene::encode
    base::Bytes wall;             // walls::Wall::encode
    double frameTimeout = 0;      // [s] without a sign of the master, after which a rank ends
    std::vector<Fault> faults{};  // made on purpose
    base::Bytes state{};          // sand::Replica::encodeState, where a session goes on; empty: as the scene begins

    [[nodiscard]] base::Bytes encode() const;
    static SessionMessage decode(std::span<const std::uint8_t> bytes);
};

/// Collective. The master opens the session, or refuses it to all with nothing; ranks get what it gave.
[[nodiscard]] std::optional<SessionMessage> broadcastSession(const Cluster& cluster,
                                                             const std::optional<SessionMessage>& fromMaster);

/// What a rank says before it takes part: who it is, and why it cannot, if it cannot.
struct Readiness {
    std::string host;
    std::string buildId;
    std::string error;     // empty when ready
    std::string renderer;  // what draws
    // What the wall file asks for and the rank's machine cannot do: for the operator.
    std::vector<std::string> shortcomings;
    // From the start: until a hardware barrier has settled, swap times say nothing.
    std::uint32_t framesToIgnore = 0;
};

/// Collective: everyone's readiness, by rank, at the master; others get nothing.
[[nodiscard]] std::vector<Readiness> gatherReadiness(const Cluster& cluster, const Readiness& mine);

/// Collective: whether the master says to go on.
[[nodiscard]] bool agreeToGoOn(const Cluster& cluster, bool master);

/// What a render rank has to report at the end.
struct RankReport {
    std::string host;
    std::string renderer;
    std::string swapLock;                          // whether graphics cards swap together in hardware
    double drawP50 = 0, drawP99 = 0, drawMax = 0;  // [ms] per frame, all eyes
    double waitP50 = 0, waitP99 = 0;               // [ms] at the barrier
    std::int64_t residentBytes = 0;
    std::int64_t frameBufferBytes = 0;
    // Views, an eye in a frame each: not drawn at all, drawn in part, drawn whole.
    std::int64_t viewsSkipped = 0, viewsInPart = 0, viewsWhole = 0;
    double pixelShare = 0;  // of all views' pixels, drawn
};

/// Collective: the render ranks' reports, by rank from 1, at the master; others get nothing. The master gives any. Who
/// is waited for is named.
[[nodiscard]] std::vector<RankReport> gatherReports(FrameBarrier& barrier, const RankReport& mine);

}  // namespace lockstep
