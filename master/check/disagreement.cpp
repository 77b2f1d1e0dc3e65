// SPDX-License-Identifier: Apache-2.0
#include "master/check/disagreement.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "host/event.hpp"
#include "host/print_line.hpp"
#include "host/regular_file.hpp"

namespace master {
namespace {

std::string placeOf(const lockstep::Divergence::Odd& odd) {
    if (odd.onlyMovement) {
        return "only in the steps in which its sand moved last";
    }
    return odd.tile < 0
               ? "in probe, step or outflow"
               : fmt::format("first in hash tile {} (columns {}..{}, rows {}..{}), {} cells of it", odd.tile,
                             odd.cells.x0, odd.cells.x1 - 1, odd.cells.y0, odd.cells.y1 - 1, odd.cellsDiffering);
}

std::string replayProgram() {
    return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "sandwall-replay").string();
}

}  // namespace

void emitDivergence(const DivergedFrame& diverged, int ranks, const std::filesystem::path& journal) {
    const lockstep::Divergence& divergence = diverged.divergence;
    nlohmann::ordered_json odd = nlohmann::ordered_json::array();
    for (const lockstep::Divergence::Odd& one : divergence.odd) {
        odd.push_back({{"rank", one.rank},
                       {"state_hash", fmt::format("{:016x}", one.hash)},
                       {"hash_tile", one.tile},
                       {"columns", {one.cells.x0, one.cells.x1 - 1}},
                       {"rows", {one.cells.y0, one.cells.y1 - 1}},
                       {"cells", one.cellsDiffering}});
    }
    nlohmann::ordered_json reproduce = nlohmann::ordered_json::array();
    if (!journal.empty()) {
        reproduce = {replayProgram(), journal.string(), "--until", std::to_string(diverged.step), "--hash"};
    }
    host::emitEvent("divergence", {{"frame", diverged.frame},
                                   {"step", diverged.step},
                                   {"state_hash", fmt::format("{:016x}", divergence.rightHash)},
                                   {"judge", base::nameOf(divergence.judge)},
                                   {"agreeing", divergence.agreeing},
                                   {"ranks", ranks},
                                   {"odd", host::Json{odd.dump()}},
                                   {"reproduce", host::Json{reproduce.dump()}}});
}

std::vector<std::string> describeDivergence(const DivergedFrame& diverged, const std::vector<std::string>& names,
                                            const std::filesystem::path& journal) {
    using Judge = lockstep::Divergence::Judge;
    const lockstep::Divergence& divergence = diverged.divergence;
    const std::string when = fmt::format("frame {}, step {}", diverged.frame, diverged.step);
    if (divergence.odd.empty()) {
        return {fmt::format("{}: hashes differed; computed again from memory, all are {:016x}", when,
                            divergence.rightHash)};
    }
    std::vector<std::string> lines;
    for (const lockstep::Divergence::Odd& odd : divergence.odd) {
        lines.push_back(fmt::format("{}: {} differs from {} of {} ranks: state hash {:016x} instead of {:016x}, {}",
                                    when, names[static_cast<std::size_t>(odd.rank)], divergence.agreeing, names.size(),
                                    odd.hash, divergence.rightHash, placeOf(odd)));
    }
    if (divergence.outvoted) {
        lines.push_back(
            fmt::format("{}: the majority was wrong; by the journal {:016x} is right", when, divergence.rightHash));
    } else if (divergence.judge != Judge::majority) {
        lines.push_back(
            divergence.judge == Judge::journal
                ? fmt::format("{}: no hash has a majority; by the journal {:016x} is right", when, divergence.rightHash)
                : fmt::format("{}: no hash has a majority, and no journal can be read; the master's "
                              "sand counts as right",
                              when));
    }
    if (journal.empty()) {
        return lines;
    }
    lines.push_back(fmt::format("reproduce the right hash with: '{}' '{}' --until {} --hash", replayProgram(),
                                journal.string(), diverged.step));
    return lines;
}

void report(const std::vector<std::string>& lines, const std::filesystem::path& file) {
    std::string text;
    for (const std::string& line : lines) {
        host::printLine("{}", line);
        text += line + '\n';
    }
    (void)host::appendLines(file, text);  // the lines are on standard error already
}

}  // namespace master
