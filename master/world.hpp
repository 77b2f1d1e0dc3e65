// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lockstep/cluster.hpp"
#include "lockstep/session_message.hpp"
#include "master/program_options.hpp"
#include "scene/model/scene.hpp"
#include "walls/wall.hpp"

namespace master {

/// Contents of the files that the user named, and the message with them for all ranks.
struct World {
    scene::Scene scene;
    walls::Wall wall;
    lockstep::SessionMessage message;
};

/// Reads the scene, the journal and the wall that `options` name, makes the folder of the session, and completes
/// `options.session`. Only rank 0 calls it, before lockstep::broadcastSession(). Throws base::InputError if a file, an
/// option or the hosts do not fit.
[[nodiscard]] World loadWorld(const lockstep::Cluster& cluster, ProgramOptions& options);

}  // namespace master
