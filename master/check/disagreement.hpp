// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "lockstep/divergence.hpp"

namespace master {

/// A frame in which the sand of some ranks differed, as the master saw it.
struct DivergedFrame {
    std::uint64_t frame = 0;
    std::uint64_t step = 0;
    const lockstep::Divergence& divergence;
};

/// Emits the event `divergence`. `ranks` is the number of ranks, including the master. `journal` is the journal's first
/// file; it is empty if there is no journal to compute the right hash from.
void emitDivergence(const DivergedFrame& diverged, int ranks, const std::filesystem::path& journal);

/// Returns a line for each rank that differs, with the place. Without a majority a line follows that names what decided
/// which sand is right. The last line is the command that computes the right hash again from the journal; it is left
/// out if `journal` is empty. `names` are the names of the ranks in messages, the master's first.
[[nodiscard]] std::vector<std::string> describeDivergence(const DivergedFrame& diverged,
                                                          const std::vector<std::string>& names,
                                                          const std::filesystem::path& journal);

/// Prints `lines` on standard error, and appends them to `file`.
void report(const std::vector<std::string>& lines, const std::filesystem::path& file);

}  // namespace master
