// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "lockstep/fault.hpp"

namespace master {

/// A fault made on purpose, and how it was asked for.
struct Drill {
    std::string text;
    lockstep::Fault fault;
};

/// What has happened of a session's drills stands in OUT/drills.done, a line each, on disk before the frame is sent in
/// which it does: whoever dies of it must not die of it again when the session is taken up once more. Slow drawing
/// alone is no event, and goes on.
///
/// Those that are still to happen. Of a session that is not taken up, all: the file is then removed.
[[nodiscard]] std::vector<Drill> withoutDone(std::vector<Drill> drills, const std::filesystem::path& folder,
                                             bool resumed);

/// Tells what happens in a frame that is about to be sent, and keeps it; returns what befalls the haptic link.
[[nodiscard]] std::vector<lockstep::Fault> beginDrills(const std::vector<Drill>& drills, std::uint64_t frame,
                                                       const std::filesystem::path& folder);

}  // namespace master
