// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "lockstep/fault.hpp"

namespace master {

/// A fault that is injected on purpose, and the user's text for it.
struct Drill {
    std::string text;
    lockstep::Fault fault;
};

/// Returns the drills of `drills` that are still to happen. A session that is not resumed has all of them to come, and
/// its file drills.done is removed.
///
/// Each drill is written as a line to `folder`/drills.done, on disk before its frame is sent, so that a resumed session
/// does not repeat it. Slow drawing is not written, and also continues after a resume.
///
[[nodiscard]] std::vector<Drill> withoutDone(std::vector<Drill> drills, const std::filesystem::path& folder,
                                             bool resumed);

/// Prints the drills of frame `frame`, which is about to be sent, and writes them to `folder`/drills.done. Returns the
/// faults of the haptic link among them.
[[nodiscard]] std::vector<lockstep::Fault> beginDrills(const std::vector<Drill>& drills, std::uint64_t frame,
                                                       const std::filesystem::path& folder);

}  // namespace master
