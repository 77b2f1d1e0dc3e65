// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/input_error.hpp"
#include "haptic_bridge/loop/tick_replay.hpp"
#include "host/command_line.hpp"
#include "host/memory.hpp"
#include "host/print_line.hpp"
#include "host/version.hpp"
#include "host/whole_file.hpp"
#include "master/journal/journal.hpp"
#include "replay/checks.hpp"
#include "replay/export.hpp"
#include "replay/recover.hpp"
#include "replay/replay_options.hpp"
#include "replay/verify.hpp"
#include "sand/replica.hpp"
#include "scene/export/raster.hpp"
#include "scene/export/results.hpp"
#include "scene/import/raster_file.hpp"
#include "scene/model/scene.hpp"

namespace {

/// Recomputes the rows of sandwall-haptic-server --record while the steps are replayed.
class Forces {
public:
    Forces(const journal::Journal& journal, const replay::ReplayOptions& options)
        : options_(options), replay_(journal.scene, {}) {
        if (options.forces.empty()) {
            return;
        }
        try {
            replay_ = haptic_bridge::TickReplay(journal.scene, journal.ticks);
        } catch (const base::FormatError& error) {
            throw base::InputError(fmt::format("{}: its tick track cannot be read: {}", options.file, error.what()));
        }
        if (replay_.empty()) {
            throw base::InputError(fmt::format(
                "{}: holds no tick track; a session keeps one whose haptic server was started with --record",
                options.file));
        }
        file_.emplace(options.forces);
        rows_ = haptic_bridge::tickTitles();
    }
    void feel(const sand::Replica& replica) {
        if (options_.forces.empty()) {
            return;
        }
        replay_.feel(replica, rows_);
        file_->stream() << rows_;
        rows_.clear();
    }
    void finish() {
        if (options_.forces.empty()) {
            return;
        }
        file_->keep();
        if (replay_.left() > 0) {
            host::printLine("{}: the last {} ticks belong to steps that the session did not show, and were left out",
                            options_.file, replay_.left());
        }
    }

private:
    const replay::ReplayOptions& options_;
    haptic_bridge::TickReplay replay_;
    std::optional<host::WholeFile> file_;
    std::string rows_;
};

/// Applies the journal's steps and checks the session's hashes on the way. Returns how many frames differed.
int replaySteps(const journal::Journal& journal, std::uint64_t until, sand::Replica& replica, Forces& forces) {
    int differing = 0;
    forces.feel(replica);
    for (const journal::JournalFrame& frame : journal.frames) {
        if (replica.stepNumber() >= until) {
            continue;
        }
        if (!frame.doubted && replica.stateHash() != frame.hashBefore && differing++ == 0) {
            host::printLine("before frame {}, after step {}: the session had {:016x}, the replay has {:016x}",
                            frame.frame, replica.stepNumber(), frame.hashBefore, replica.stateHash());
        }
        for (const sand::Step& step : frame.steps) {
            if (step.number <= until) {
                replica.apply(step);
                forces.feel(replica);
            }
        }
    }
    return differing;
}

void writeRasters(const sand::HeightField& field, const scene::Scene& scene, const replay::ReplayOptions& options) {
    if (!options.heights.empty()) {
        scene::writeRaster(scene::heightsOf(field, scene), options.heights);
    }
    if (!options.difference.empty()) {
        scene::writeRaster(scene::differenceOf(field, scene), options.difference);
    }
    if (options.volumes) {
        const scene::Earthwork work = scene::earthworkOf(field, scene);
        const auto both = [&](double unit) -> nlohmann::ordered_json {
            return {{"cut", static_cast<double>(work.cut) * unit}, {"fill", static_cast<double>(work.fill) * unit}};
        };
        nlohmann::ordered_json json;
        json["units"] = {{"cut", work.cut}, {"fill", work.fill}};
        json["cubic_scene_units"] = both(work.unit);
        json["cubic_metres"] = work.cubicMetres > 0 ? both(work.cubicMetres) : nullptr;
        fmt::print("{}\n", json.dump());
    }
}

void writeOutputs(const sand::Replica& replica, const scene::Scene& scene, const replay::ReplayOptions& options) {
    if (!options.mesh.empty()) {
        scene::writeMesh(scene::meshOf(replica, scene), options.mesh);
    }
    if (!options.heights.empty() || !options.difference.empty() || options.volumes) {
        scene::withCells(replica, scene, [&](const sand::HeightField& field, const scene::Scene& began) {
            writeRasters(field, began, options);
        });
    }
}

int run(const replay::ReplayOptions& options) {
    const std::int64_t free = host::freeMemoryOfProcess();
    if (!options.recovered.empty()) {
        replay::requireMemory(options.file, replay::DecodedFor::scene, free);
        replay::recoverJournal(options.file, options.recovered);
        return 0;
    }
    if (options.verify) {
        replay::requireMemory(options.file, replay::DecodedFor::replica, free);
        return replay::verifyJournal(options.file);
    }
    options.checkOutputs();
    const bool onlyExports = !options.steps.empty() && options.plain();
    replay::requireMemory(options.file, onlyExports ? replay::DecodedFor::scene : replay::DecodedFor::replica, free);
    if (!options.steps.empty()) {
        replay::exportSteps(options.file, options.steps, options.until);
        if (onlyExports) {
            return 0;  // the export needs no sand
        }
    }
    const journal::Journal journal = master::readJournal(options.file);
    if (options.steps.empty()) {  // the export has printed it
        replay::printMissing(options.file, journal.tornBytes, journal.end.has_value());
    }
    sand::Replica replica(journal.scene);
    Forces forces(journal, options);
    int differing =
        replaySteps(journal, options.until.value_or(std::numeric_limits<std::uint64_t>::max()), replica, forces);
    forces.finish();
    replay::requireStep(options.file, replica.stepNumber(), options.until);
    const bool whole = journal.end && journal.end->step == replica.stepNumber();
    if (whole && journal.end->hash != replica.stateHash()) {
        host::printLine("after step {}: the session had {:016x}, the replay has {:016x}", replica.stepNumber(),
                        journal.end->hash, replica.stateHash());
        ++differing;
    }
    if (options.hash) {
        fmt::print("{:016x}\n", replica.stateHash());
    }
    if (options.plain()) {
        fmt::print("{}: {} steps replayed, state hash {:016x}; {}\n", options.file, replica.stepNumber(),
                   replica.stateHash(), differing == 0 ? "no hash differs from the session's" : "hashes differ");
    }
    writeOutputs(replica, journal.scene, options);
    return differing == 0 ? 0 : 1;
}

/// Throws base::InputError if the output could not be printed, for example to a full disk.
void requirePrinted() {
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        throw base::InputError(fmt::format("standard output: cannot be written ({})", std::strerror(errno)));
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (host::answersVersion(argc, argv, "sandwall-replay",
                             {{"algorithm", sand::kAlgorithmVersion},
                              {"journal", journal::kJournalVersion},
                              {"state", sand::kStateVersion}})) {
        return 0;
    }
    host::CommandLine line(
        "Replays the journal of a session, bit for bit, and checks it against the session's own hashes.\n"
        "Exit status: 0 equal, 1 different, 2 unusable.",
        "sandwall-replay");
    replay::ReplayOptions options;
    options.addTo(line);
    return host::runMain(
        line, argc, argv,
        [&] {
            options.file = master::journalAt(options.file).string();
            const int status = run(options);
            requirePrinted();
            return status;
        },
        base::kExitBadInput);
}
