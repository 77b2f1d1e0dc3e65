// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scene/model/session_memory.hpp"

namespace scene {

/// Times of the phases of a session's start, estimated from the number of cells.
struct StartTime {
    double read = 0;      // [s], to read the terrain
    double replica = 0;   // [s], for the replicas and the message of the scene
    double drawing = 0;   // [s], for the first frame
    double programs = 0;  // [s], for the programs, whatever the scene is

    [[nodiscard]] static StartTime of(const SandSize& sand);
    [[nodiscard]] double sum() const { return read + replica + drawing + programs; }
    /// Returns one line for the user. The sum has a mark, because it is an estimate.
    [[nodiscard]] std::string text() const;
};

}  // namespace scene
