// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "master/drills.hpp"
#include "master/film.hpp"
#include "master/journal/recording.hpp"
#include "master/master_sand.hpp"
#include "master/operator_desk.hpp"
#include "master/session_record.hpp"
#include "master/steps/step_source.hpp"
#include "scene/scene.hpp"

namespace master {

inline constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

/// How a session runs.
struct SessionOptions {
    std::optional<haptic_bridge::Address> server;
    haptic_bridge::LinkSecurity security;  // of the link with it
    Pace pace = Pace::realtime;
    std::optional<double> refreshHz;   // frames per second; none: the wall file's
    std::uint64_t steps = kNoLimit;    // ends when exactly this many have been shown
    std::uint64_t frames = kNoLimit;   // ends after this many
    std::uint64_t settlingFrames = 0;  // from the start, whose times do not count
    double frameTimeout = 30;          // [s] that a frame may take before the job ends
    bool pictures = true;
    std::filesystem::path out;
    DeskOptions desk;
    RecordOptions record;
    sand::grid::Erosion::Options sweeps;         // how the master's own replica is swept
    std::shared_ptr<const Recording> recording;  // steps come from there, and no journal is written
    bool film = false;                           // every frame becomes a picture, and there are no others
    std::optional<FilmEye> filmEye;
    std::vector<Drill> drills;  // still to happen
};

/// Returns the options with all that a recording, if there is one, says of them.
[[nodiscard]] SessionOptions completed(SessionOptions options);
/// Makes the parts of a session that its options choose: the steps of a hand or of a recording, and the sand of the
/// scene or of the session that goes on.
[[nodiscard]] std::unique_ptr<StepSource> stepsOf(const SessionOptions& options, const scene::Scene& scene);
[[nodiscard]] MasterSand sandOf(const SessionOptions& options, const scene::Scene& scene);

}  // namespace master
