// SPDX-License-Identifier: Apache-2.0
#include "master/journal/resume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <new>
#include <utility>

#include "base/input_error.hpp"
#include "host/memory.hpp"
#include "host/print_line.hpp"
#include "master/journal/checkpoint.hpp"
#include "master/journal/journal.hpp"
#include "scene/load/memory.hpp"

namespace master {
namespace {

namespace fs = std::filesystem;

/// Error when a hash in the journal differs from the hash of the replayed sand.
class OtherSand : public base::InputError {
public:
    using base::InputError::InputError;
};

void requireHash(sand::Replica& terrain, const JournalEnd& said, const fs::path& journal) {
    if (terrain.stepNumber() == said.step && terrain.stateHash() != said.hash) {
        throw OtherSand(fmt::format(
            "{}: after step {} the session had {:016x}, the replay has {:016x}; it is of another version or damaged",
            journal.string(), said.step, said.hash, terrain.stateHash()));
    }
}

/// Applies the journal's steps up to `step` that `terrain` does not have yet. Returns how many it has applied.
std::uint64_t replayUntil(const fs::path& journal, std::uint64_t step, sand::Replica& terrain) {
    const std::uint64_t first = terrain.stepNumber();
    JournalReader reader(journal);
    while (const auto record = reader.next()) {
        if (const auto* end = std::get_if<JournalEnd>(&*record)) {
            requireHash(terrain, *end, journal);
        }
        const auto* frame = std::get_if<JournalFrame>(&*record);
        if (frame == nullptr || frame->steps.empty() || frame->steps.back().number <= terrain.stepNumber()) {
            continue;
        }
        if (frame->steps.front().number > terrain.stepNumber() + 1) {
            throw base::InputError(fmt::format("{}: step {} follows step {}; a part of the session is missing",
                                               journal.string(), frame->steps.front().number, terrain.stepNumber()));
        }
        requireHash(terrain, {frame->steps.front().number - 1, frame->hashBefore}, journal);
        for (const sand::Step& one : frame->steps) {
            if (one.number == terrain.stepNumber() + 1 && one.number <= step) {
                terrain.apply(one);
            }
        }
        if (terrain.stepNumber() >= step && frame->steps.back().number > step) {
            break;
        }
    }
    if (terrain.stepNumber() < step) {
        throw base::InputError(
            fmt::format("{}: ends at step {}, before step {}", journal.string(), terrain.stepNumber(), step));
    }
    return terrain.stepNumber() - first;
}

/// Collects from the records everything of a session that needs no sand.
struct Walk {
    ResumedSession& session;
    const fs::path& journal;
    std::optional<scene::Material> pending;  // of the next steps, which a crash may have cut off

    void operator()(const JournalFrame& frame) {
        session.frame = std::max(session.frame, frame.frame);
        session.material = std::exchange(pending, std::nullopt).value_or(session.material);
        for (const sand::Step& step : frame.steps) {
            if (step.number != session.step + 1) {
                throw base::InputError(fmt::format("{}: step {} follows step {}; a part of the session is missing",
                                                   journal.string(), step.number, session.step));
            }
            session.step = step.number;
            session.epoch = std::max(session.epoch, step.epoch);
            session.edits += step.edit.any() ? 1 : 0;
        }
    }
    void operator()(const scene::Material& material) { pending = material; }
    void operator()(const JournalResumed& resumed) {
        session.frame = std::max(session.frame, resumed.frame);
        pending.reset();
    }
    void operator()(const JournalEnd&) const {}
    void operator()(const JournalTicks&) const {}
    void operator()(const JournalContinued&) const {}
};

void requireScene(const JournalReader& reader, const std::string& file) {
    if (file.empty()) {
        return;
    }
    const auto fail = [&] {
        throw base::InputError(
            fmt::format("{}: is not the scene of the session in {}; leave --scene out to continue "
                        "that session, or choose another --out",
                        file, reader.place().journal.string()));
    };
    const auto raster = scene::checksOfOneReplica(file, host::freeMemoryOfProcess()).raster;
    // Refuses a scene of another size before its heights are made.
    const auto otherSize = [&, rules = rulesOf(reader)](int columns, int rows, bool tin) {
        if (columns != rules.columns || rows != rules.rows || tin != (rules.tin != 0)) {
            fail();
        }
    };
    if (scene::loadScene(file, {.raster = raster, .field = otherSize}).encode() != reader.header().scene) {
        fail();
    }
}

}  // namespace

sand::Replica sandOfCheckpoint(const fs::path& file, const JournalHeader& header, const sand::Replica& start) {
    const Checkpoint checkpoint = readCheckpoint(file);
    if (checkpoint.session != header.session || checkpoint.sceneDigest != start.rules().digest()) {
        throw base::FormatError("is of another session");
    }
    sand::Replica terrain = start;
    terrain.decodeState(checkpoint.state);
    if (terrain.stepNumber() != checkpoint.step || terrain.stateHash() != checkpoint.stateHash) {
        throw base::FormatError("its sand differs from its hash");
    }
    return terrain;
}

RestoredSand restoreSand(const fs::path& journal, std::uint64_t step, const sand::grid::Erosion::Options& sweeps) {
    const JournalReader head(journal);
    const sand::Replica start(sceneOf(head), sweeps);
    for (const std::uint64_t at : checkpointsOf(journal)) {
        const fs::path file = checkpointFile(journal, at);
        try {
            if (at <= step) {
                RestoredSand restored{sandOfCheckpoint(file, head.header(), start), at, 0};
                restored.replayedSteps = replayUntil(journal, step, restored.terrain);
                return restored;
            }
        } catch (const base::FormatError& error) {
            host::printLine("{}: {}; it is left out", file.string(), error.what());
        } catch (const std::bad_alloc&) {
            host::printLine("{}: this machine has no memory for it; it is left out", file.string());
        } catch (const OtherSand& error) {
            host::printLine("{}: it is left out: {}", file.string(), error.what());
        }
    }
    RestoredSand restored{start, 0, 0};
    restored.replayedSteps = replayUntil(journal, step, restored.terrain);
    return restored;
}

std::optional<ResumedSession> readSession(const fs::path& journal, const std::string& scene,
                                          const sand::grid::Erosion::Options& sweeps) {
    std::error_code none;
    if (!fs::exists(journal, none)) {
        return std::nullopt;
    }
    JournalReader reader(journal);
    requireScene(reader, scene);
    ResumedSession session;
    session.scene = sceneOf(reader);
    session.scene.material = session.material = reader.header().material.value_or(scene::Material());
    try {
        Walk walk{session, journal, {}};
        while (const auto record = reader.next()) {
            std::visit(walk, *record);
        }
    } catch (const base::InputError& error) {
        throw base::InputError(
            fmt::format("{}; sandwall-replay {} --recover NEW/session.journal saves the intact part, and --out NEW "
                        "--resume continues it",
                        error.what(), journal.string()));
    }
    session.place = reader.place();
    session.cutBytes = reader.tornBytes();
    RestoredSand restored = restoreSand(journal, session.step, sweeps);
    session.hash = restored.terrain.stateHash();
    session.state = restored.terrain.encodeState();
    session.checkpointStep = restored.checkpointStep;
    session.replayedSteps = restored.replayedSteps;
    return session;
}

}  // namespace master
