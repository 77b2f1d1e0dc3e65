// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/field_forms.hpp"
#include "lockstep/cluster.hpp"
#include "lockstep/fault.hpp"
#include "lockstep/message_limits.hpp"
#include "scene/model/scene.hpp"

namespace lockstep {

class FrameBarrier;

/// Message that every rank gets before the first frame. Render ranks read no file: the scene and the wall come from the
/// master. broadcastSession() sends `scene` by itself, because it may have gigabytes.
struct SessionMessage {
    base::Bytes scene;            // scene::Scene::encode
    base::Bytes wall;             // walls::Wall::encode
    double frameTimeout = 0;      // [s] without a message from the master, after which a rank ends
    std::vector<Fault> faults{};  // of the session's drills
    bool pointer = false;         // whether the hand is the pointer of the ranks' windows
    std::string sceneName{};      // shown in the titles of windows
    bool resumes = false;         // whether broadcastState() follows

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("scene", base::block(it.scene));
        visit("wall", base::block(it.wall));
        visit("frame_timeout_s", it.frameTimeout);
        visit("faults", base::upTo(it.faults, kMostFaults));
        visit("pointer", it.pointer);
        visit("scene_name", base::text(it.sceneName, kMostText));
        visit("resumes", it.resumes);
    }
};

/// Returns the master's argument `fromMaster` on the render ranks, and nullopt at the master. With null the master
/// refuses the session. Takes the content of `fromMaster`. `sent` is called as Cluster::broadcast() does. Collective.
[[nodiscard]] std::optional<SessionMessage> broadcastSession(const Cluster& cluster, SessionMessage* fromMaster,
                                                             const std::function<void(double)>& sent = {});
/// Returns the master's argument `fromMaster` on the render ranks: the state of a resumed session,
/// sand::Replica::encodeState(). The ranks decode the scene while the master computes it. Without bytes the master
/// refuses the session. `sent` is called as Cluster::broadcast() does. Collective, after broadcastSession() if the
/// session resumes.
[[nodiscard]] base::Bytes broadcastState(const Cluster& cluster, const base::Bytes& fromMaster,
                                         const std::function<void(double)>& sent = {});

/// Message of a rank before the session: where it runs, and why it cannot take part, if it cannot.
struct Readiness {
    std::string host;
    std::string buildId;
    std::string error;     // why the rank cannot take part; empty if it can
    std::string renderer;  // name of the OpenGL renderer
    // Requests of the wall file that the rank's machine cannot meet, as lines for the operator.
    std::vector<std::string> shortcomings;
    // Number of first frames whose swap times do not count, because a hardware barrier has not settled yet.
    std::uint32_t framesToIgnore = 0;
    // The float arithmetic of the rank's thread after its OpenGL driver was loaded, in words, if the sand needs another
    // one. The rank has set it back. Empty if nothing was changed.
    std::string otherFloats{};
    std::string tile{};  // name of the tile that the rank draws; empty at the master
    // Whether `error` is about something that a later start may find (base::NotYetError).
    bool mayStillCome = false;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("host", base::text(it.host, kMostText));
        visit("build", base::text(it.buildId, kMostText));
        visit("error", base::text(it.error, kMostText));
        visit("renderer", base::text(it.renderer, kMostText));
        visit("other_floats", base::text(it.otherFloats, kMostText));
        visit("tile", base::text(it.tile, kMostText));
        visit("shortcomings", base::texts(it.shortcomings, kMostText));
        visit("frames_to_ignore", it.framesToIgnore);
        visit("may_still_come", it.mayStillCome);
    }
};

/// Returns the readiness of all ranks at the master, in order of rank; an empty list on other ranks. `made` is called
/// as Cluster::gatherReady() does. Collective.
[[nodiscard]] std::vector<Readiness> gatherReadiness(const Cluster& cluster, const Readiness& mine,
                                                     const std::function<void(double)>& made = {});

/// Returns the master's argument `master` on all ranks: whether the session begins. Collective.
[[nodiscard]] bool agreeToGoOn(const Cluster& cluster, bool master);

/// Report of a render rank at the end of a session.
struct RankReport {
    std::string host;
    std::string renderer;
    std::string swapLock;                          // whether and how graphics cards swap together in hardware
    double drawP50 = 0, drawP99 = 0, drawMax = 0;  // [ms] per frame, all eyes
    double waitP50 = 0, waitP99 = 0;               // [ms] at the barrier
    std::int64_t residentBytes = 0;
    std::int64_t frameBufferBytes = 0;
    // Numbers of views that were not drawn, drawn in part, and drawn whole. A view is one eye in one frame.
    std::int64_t viewsSkipped = 0, viewsInPart = 0, viewsWhole = 0;
    double pixelShare = 0;  // share of all views' pixels that were drawn
    /// The names are the keys in `per_rank` of summary.json.
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("host", base::text(it.host, kMostText));
        visit("renderer", base::text(it.renderer, kMostText));
        visit("swap_lock", base::text(it.swapLock, kMostText));
        visit("draw_ms/p50", it.drawP50);
        visit("draw_ms/p99", it.drawP99);
        visit("draw_ms/max", it.drawMax);
        visit("barrier_wait_ms/p50", it.waitP50);
        visit("barrier_wait_ms/p99", it.waitP99);
        visit("memory_bytes", it.residentBytes);
        visit("frame_buffer_bytes", it.frameBufferBytes);
        visit("views/skipped", it.viewsSkipped);
        visit("views/in_part", it.viewsInPart);
        visit("views/whole", it.viewsWhole);
        visit("views/pixel_share", it.pixelShare);
    }
};

/// Returns the reports of the render ranks at the master, in order of rank from 1; an empty list on other ranks. The
/// master's own argument is ignored. If a report is late, the watchdog names the rank. Collective.
[[nodiscard]] std::vector<RankReport> gatherReports(FrameBarrier& barrier, const RankReport& mine);

}  // namespace lockstep
