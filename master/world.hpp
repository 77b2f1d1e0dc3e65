// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/byte_stream.hpp"
#include "lockstep/cluster.hpp"
#include "lockstep/session_message.hpp"
#include "master/journal/resume.hpp"
#include "master/program_options.hpp"
#include "scene/model/scene.hpp"
#include "walls/wall.hpp"

namespace master {

/// Contents of the files that the user named, and the message with them for all ranks.
struct World {
    scene::Scene scene;
    walls::Wall wall;
    lockstep::SessionMessage message;
    std::optional<StoppedSession> stopped;  // session that --resume continues; nullopt for a new one
};

/// Reads the scene, the journal and the wall that `options` name, makes the folder of the session, and completes
/// `options.session`. Only rank 0 calls it, before lockstep::broadcastSession(). Throws base::InputError if a file, an
/// option or the hosts do not fit.
[[nodiscard]] World loadWorld(const lockstep::Cluster& cluster, ProgramOptions& options);

/// Computes the sand of World::stopped, which it takes, while the ranks decode the scene. Sets `options.session` to
/// continue it, and returns its state for lockstep::broadcastState(). Tells the ranks of `cluster` the progress. Throws
/// base::InputError if the session cannot be continued, or if its scene is not that of --scene.
[[nodiscard]] base::Bytes resumeSand(const lockstep::Cluster& cluster, World& world, ProgramOptions& options);

}  // namespace master
