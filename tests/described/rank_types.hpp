// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tuple>

#include "lockstep/divergence.hpp"
#include "lockstep/fault.hpp"
#include "lockstep/frame_message.hpp"
#include "lockstep/healing.hpp"
#include "lockstep/host_memory.hpp"
#include "lockstep/session_message.hpp"

namespace described {

/// Every described type of lockstep/. They are in a list of their own, because their headers need MPI.
using RankTypes = std::tuple<lockstep::Overlays, lockstep::ViewState, lockstep::Answer, lockstep::FrameMessage,
                             lockstep::Drag, lockstep::WallFigures, lockstep::Fault, lockstep::SessionMessage,
                             lockstep::Readiness, lockstep::RankReport, lockstep::RankHost, lockstep::Remedy,
                             lockstep::Account, lockstep::TileRequest, lockstep::TileValues>;

}  // namespace described
