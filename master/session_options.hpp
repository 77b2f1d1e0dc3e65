// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "haptic_bridge/hand/pace.hpp"
#include "journal/recording.hpp"
#include "master/drills/drills.hpp"
#include "master/operator/operator_desk.hpp"
#include "master/pictures/film.hpp"
#include "master/session_record.hpp"
#include "master/steps/master_sand.hpp"
#include "master/steps/step_source.hpp"
#include "scene/model/scene.hpp"

namespace master {

inline constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

/// Options of a session.
struct SessionOptions {
    std::optional<haptic_bridge::Address> server;
    haptic_bridge::LinkSecurity security;  // of the link to the server
    std::optional<double> forceShare;      // as if an operator had set it at the start, 0 to 1; wins over the journal
    bool pointer = false;                  // the hand is the pointer of the ranks' windows
    haptic_bridge::Pace pace = haptic_bridge::Pace::realtime;
    std::optional<double> refreshHz;   // frames per second; nullopt: as in the wall file
    std::uint64_t steps = kNoLimit;    // the session ends when exactly this many steps have been shown
    std::uint64_t frames = kNoLimit;   // the session ends after this many frames
    std::uint64_t settlingFrames = 0;  // number of first frames whose times do not count
    double frameTimeout = 30;          // [s], time that a frame may take before the job ends
    bool pictures = true;
    bool report = true;  // prints the main figures at the end; the launcher prints its own from summary.json
    std::filesystem::path out;
    DeskOptions desk;
    RecordOptions record;
    const base::Executor* executor = nullptr;             // for the master's own replicas; see sand::Replica
    std::shared_ptr<const journal::Recording> recording;  // source of the steps of a replay, which writes no journal
    bool film = false;                                    // writes a picture of every frame, and no other pictures
    std::optional<FilmEye> filmEye;
    std::vector<Drill> drills;              // drills that are still to happen
    std::function<void()> firstFrameShown;  // called once, on the main thread
};

/// Returns `options` adapted to their recording, if there is one.
[[nodiscard]] SessionOptions completed(SessionOptions options);
/// Create the parts of a session that its options choose. stepsOf() returns the steps of a hand or of a recording.
/// sandOf() takes the heights of the scene, or the sand of the resumed session.
[[nodiscard]] std::unique_ptr<StepSource> stepsOf(const SessionOptions& options, const scene::Scene& scene,
                                                  Edits& edits);
[[nodiscard]] MasterSand sandOf(const SessionOptions& options, scene::Scene& scene);

}  // namespace master
