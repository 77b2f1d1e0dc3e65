// SPDX-License-Identifier: Apache-2.0
#include "master/disagreement.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>

namespace master {
namespace {

std::string placeOf(const lockstep::Divergence::Odd& odd) {
    return odd.tile < 0
               ? "in pose, step or outflow"
               : fmt::format("first in hash tile {} (columns {}..{}, rows {}..{}), {} cells of it", odd.tile,
                             odd.cells.x0, odd.cells.x1 - 1, odd.cells.y0, odd.cells.y1 - 1, odd.cellsDiffering);
}

}  // namespace

std::vector<std::string> describeDivergence(const DivergedFrame& diverged, const std::vector<std::string>& names,
                                            const std::filesystem::path& journal) {
    const lockstep::Divergence& divergence = diverged.divergence;
    std::vector<std::string> lines;
    for (const lockstep::Divergence::Odd& odd : divergence.odd) {
        lines.push_back(
            fmt::format("frame {}, step {}: {} holds other sand than {} of {} ranks: {:016x} and not "
                        "{:016x}, {}",
                        diverged.frame, diverged.step, names[static_cast<std::size_t>(odd.rank)], divergence.agreeing,
                        names.size(), odd.hash, divergence.majorityHash, placeOf(odd)));
    }
    if (divergence.tie) {
        lines.emplace_back("no hash has a majority; the master's was taken for right");
    }
    const std::filesystem::path replay =
        std::filesystem::read_symlink("/proc/self/exe").parent_path() / "sandwall-replay";
    lines.push_back(fmt::format("reproduce the right hash with: '{}' '{}' --until {} --hash", replay.string(),
                                journal.string(), diverged.step));
    return lines;
}

void tell(const std::vector<std::string>& lines, const std::filesystem::path& file) {
    std::ofstream kept(file);
    for (const std::string& line : lines) {
        fmt::print(stderr, "sandwall: {}\n", line);
        kept << line << '\n';
    }
}

}  // namespace master
