// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "lockstep/divergence.hpp"

namespace master {

/// A frame on which some rank held other sand, as the master saw it.
struct DivergedFrame {
    std::uint64_t frame = 0;
    std::uint64_t step = 0;
    const lockstep::Divergence& divergence;
};

/// Emits the event `divergence`. `ranks` counts the master; `journal` as below.
void emitDivergence(const DivergedFrame& diverged, int ranks, const std::filesystem::path& journal);

/// Who differs and where, a line each, who says what is right where no hash has a majority, and how to compute that
/// hash again from the journal; of that nothing where `journal` is empty. `names` are those of the ranks, the master's
/// first.
[[nodiscard]] std::vector<std::string> describeDivergence(const DivergedFrame& diverged,
                                                          const std::vector<std::string>& names,
                                                          const std::filesystem::path& journal);

/// Prints the lines on standard error, and adds them to a file.
void tell(const std::vector<std::string>& lines, const std::filesystem::path& file);

}  // namespace master
