// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "haptic_bridge/link/link_options.hpp"
#include "master/journal/journal.hpp"
#include "master/session_options.hpp"

namespace host {
class CommandLine;
}

namespace master {

/// Options of sandwall-master as the user wrote them. loadWorld() completes `session` from the other members.
struct ProgramOptions {
    std::string scene, replay, wall, haptic = "none", out;
    int framesPerSecond = 30;   // of a replay
    journal::Span span;         // of a film
    std::string view;           // of a film; empty: frames the terrain
    std::string stereo, track;  // empty: as in the wall file
    std::string desk;           // empty: the wall is not shown on a desktop
    std::string pattern = "none";
    std::vector<std::string> layers;
    std::vector<std::string> injections;
    std::vector<std::string> places;
    bool noPictures = false;
    bool noReport = false;
    SessionOptions session;
    bool resume = false;
    std::int64_t partMegabytes = kPartBytes >> 20;
    haptic_bridge::LinkOptions link;
    int sandThreads = 1;

    /// Adds these options to `line`.
    void addTo(host::CommandLine& line);
};

}  // namespace master
