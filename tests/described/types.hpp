// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tuple>

#include "haptic_bridge/link/protocol.hpp"
#include "haptic_bridge/loop/tick_track.hpp"
#include "journal/format.hpp"
#include "master/journal/checkpoint.hpp"
#include "master/journal/saved_sand.hpp"
#include "sand/model/rules.hpp"
#include "sand/replica.hpp"
#include "sand/tin/geometry/tin_start.hpp"
#include "scene/model/scene.hpp"
#include "walls/wall.hpp"

namespace described {

/// Every described type (base/fields.hpp) whose bytes come from a link, a file or another rank, except those of
/// rank_types.hpp. The fuzzers try all of them.
using Types = std::tuple<
    // messages of the link
    haptic_bridge::Identity, haptic_bridge::Hello, haptic_bridge::Challenge, haptic_bridge::Welcome,
    haptic_bridge::Refusal, haptic_bridge::Proof, haptic_bridge::Loading, haptic_bridge::PositionGreeting,
    haptic_bridge::ForceShare, haptic_bridge::StartMessage, haptic_bridge::State, haptic_bridge::Shown,
    haptic_bridge::FrameCost, haptic_bridge::TimingEcho, haptic_bridge::Ping, haptic_bridge::EditRequest,
    haptic_bridge::CatchUp, haptic_bridge::Ready, haptic_bridge::NeedState, haptic_bridge::StepMessage,
    haptic_bridge::TimingTest, haptic_bridge::Pong, haptic_bridge::TickPiece, haptic_bridge::Position,
    haptic_bridge::Bye, haptic_bridge::Report, haptic_bridge::TrackHeader,
    // files
    journal::FileOrigin, master::Checkpoint, master::SandPlace, master::SavedSand, journal::JournalHeader,
    journal::JournalFrame, journal::JournalEnd, journal::JournalResumed, journal::JournalTicks, journal::JournalDoubt,
    journal::JournalChecked, journal::JournalContinued, journal::JournalForce,
    // scenes
    sand::Rules, sand::Tuning, sand::Tool, sand::Heading, sand::Owed, sand::StateHead, sand::ForceConstants,
    scene::Look, scene::Material, scene::Georeference, scene::RasterStatement, sand::tin::Holes::Run,
    sand::tin::TinStart,
    // walls
    walls::Screen, walls::Output, walls::Place, walls::Tile, walls::Viewer, walls::Clip, walls::Stage, walls::Grid,
    walls::Wall>;

}  // namespace described
