// SPDX-License-Identifier: Apache-2.0
#include "master/journal/resume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <new>
#include <utility>

#include "base/input_error.hpp"
#include "host/print_line.hpp"
#include "master/journal/checkpoint.hpp"
#include "master/journal/journal.hpp"

namespace master {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

/// Error when a hash in the journal differs from the hash of the replayed sand.
class OtherSand : public base::InputError {
public:
    using base::InputError::InputError;
};

void requireHash(sand::Replica& replica, const journal::JournalEnd& recorded, const fs::path& journal) {
    if (replica.stepNumber() == recorded.step && replica.stateHash() != recorded.hash) {
        throw OtherSand(fmt::format(
            "{}: after step {} the session had {:016x}, the replay has {:016x}; it is of another version or damaged",
            journal.string(), recorded.step, recorded.hash, replica.stateHash()));
    }
}

/// Returns the part of a journal that `reader` has read. `all` is its allBytes().
double partRead(const journal::JournalReader& reader, double all) {
    return std::min(1.0, static_cast<double>(reader.wholeBytes()) / std::max(all, 1.0));
}

/// Replays the records of a journal, one after another, until a step is reached.
class Replay {
public:
    Replay(const fs::path& journal, std::uint64_t step, RestoredSand& restored, const Restoring& how)
        : journal_(journal),
          step_(step),
          replica_(restored.replica),
          outvoted_(restored.outvoted),
          how_(how),
          first_(replica_.stepNumber()),
          bytes_(how.progress ? static_cast<double>(allBytes(journal)) : 0) {}

    void run() {
        reader_ = how_.opened != nullptr ? openAgain(journal_, *how_.opened) : openJournal(journal_);
        while (!(how_.beingWritten && replica_.stepNumber() >= step_) && !beyond_) {
            const auto record = reader_->next();
            if (!record) {
                break;
            }
            std::visit(*this, *record);
            tell(replica_.stepNumber());
        }
        if (how_.progress) {
            how_.progress(1);  // also if the journal ends within a record
        }
        if (replica_.stepNumber() < step_) {
            throw base::InputError(
                fmt::format("{}: ends at step {}, before step {}", journal_.string(), replica_.stepNumber(), step_));
        }
    }

    void operator()(const journal::JournalFrame& frame) {
        if (frame.steps.empty()) {
            if (!frame.doubted) {
                requireHash(replica_, {read_, frame.hashBefore}, journal_);
            }
            return;
        }
        read_ = frame.steps.back().number;
        if (read_ <= replica_.stepNumber()) {
            return;
        }
        const std::uint64_t next = frame.steps.front().number;
        if (next > replica_.stepNumber() + 1) {
            throw base::InputError(fmt::format("{}: step {} follows step {}; a part of the session is missing",
                                               journal_.string(), next, replica_.stepNumber()));
        }
        if (!frame.doubted) {
            requireHash(replica_, {next - 1, frame.hashBefore}, journal_);
        }
        for (const sand::Step& one : frame.steps) {
            if (one.number == replica_.stepNumber() + 1 && one.number <= step_) {
                replica_.apply(one);
                tell(one.number);
            }
        }
        beyond_ = read_ > step_;
    }
    void operator()(const journal::JournalEnd& end) { requireHash(replica_, end, journal_); }
    void operator()(const journal::JournalDoubt& doubt) {
        if (doubt.sand.step == replica_.stepNumber() && doubt.sand.hash != replica_.stateHash() && !outvoted_) {
            outvoted_ = Outvoted{doubt, replica_.stateHash()};
        }
    }
    void operator()(const journal::JournalChecked& checked) { endDoubt(checked.sand); }
    void operator()(const journal::JournalResumed& resumed) { endDoubt(resumed.sand); }
    void operator()(const journal::JournalTicks&) const {}
    void operator()(const scene::Material&) const {}
    void operator()(const journal::JournalContinued&) const {}
    void operator()(const journal::JournalForce&) const {}

private:
    void tell(std::uint64_t step) const {
        if (how_.each) {
            how_.each(step);
        }
        if (how_.progress) {
            const auto due = static_cast<double>(step_ - std::min(step_, first_));
            const double applied = due > 0 ? static_cast<double>(step - std::min(step, first_)) / due : 1;
            how_.progress((partRead(*reader_, bytes_) + std::min(1.0, applied)) / 2);
        }
    }
    void endDoubt(const journal::JournalEnd& sand) {
        requireHash(replica_, sand, journal_);
        outvoted_.reset();
    }

    const fs::path& journal_;
    const std::uint64_t step_;
    sand::Replica& replica_;
    std::optional<Outvoted>& outvoted_;
    const Restoring& how_;
    const std::uint64_t first_;                     // step of the sand before the replay
    const double bytes_;                            // size of the journal; 0 without Restoring::progress
    std::optional<journal::JournalReader> reader_;  // since run()
    std::uint64_t read_ = 0;  // last step of the records so far, which the replica may have had already
    bool beyond_ = false;     // a record behind the step has been read, with the hash after it
};

/// Collects from the records everything of a session that needs no sand.
struct Walk {
    ResumedSession& session;
    const fs::path& journal;
    std::optional<scene::Material> pending;  // of the next steps, which a crash may have cut off
    std::uint64_t doubted = kNever;          // first step whose sand a majority has decided, and no check confirmed

    void operator()(const journal::JournalFrame& frame) {
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
            session.lastEdit = std::max(session.lastEdit, step.edit.number);
        }
    }
    void operator()(const scene::Material& material) { pending = material; }
    void operator()(const journal::JournalResumed& resumed) {
        session.frame = std::max(session.frame, resumed.frame);
        pending.reset();
        doubted = kNever;
    }
    void operator()(const journal::JournalDoubt& doubt) { doubted = std::min(doubted, doubt.sand.step); }
    void operator()(const journal::JournalChecked&) { doubted = kNever; }
    void operator()(const journal::JournalEnd&) const {}
    void operator()(const journal::JournalTicks&) const {}
    void operator()(const journal::JournalContinued&) const {}
    void operator()(const journal::JournalForce& force) { session.forceShare = force.share; }
};

/// Gives `restored` the sand of the checkpoint of step `at`. Returns false after a line that says why it is left out;
/// the replica may then have any sand. Only the checkpoint is left out if this machine has no memory: without memory
/// for a step, no checkpoint helps the replay.
bool useCheckpoint(const fs::path& journal, std::uint64_t at, const Restoring& how, RestoredSand& restored) {
    const fs::path file = checkpointFile(journal, at);
    try {
        base::Bytes state = replaceByCheckpoint(file, how.opened->header(), restored.replica);
        restored.checkpointStep = at;
        if (how.keepState) {
            restored.state = std::move(state);
        }
        return true;
    } catch (const base::FormatError& error) {
        host::printLine("{}: {}; it is left out", file.string(), error.what());
    } catch (const std::bad_alloc&) {
        host::printLine("{}: this machine has no memory for it; it is left out", file.string());
    }
    return false;
}

}  // namespace

base::Bytes replaceByCheckpoint(const fs::path& file, const journal::JournalHeader& header, sand::Replica& replica) {
    Checkpoint checkpoint = readCheckpoint(file);
    if (checkpoint.session != header.session || checkpoint.sceneDigest != replica.rules().digest()) {
        throw base::FormatError("is of another session");
    }
    replica.decodeStateInPlace(checkpoint.state);
    if (replica.stepNumber() != checkpoint.step || replica.stateHash() != checkpoint.stateHash) {
        throw base::FormatError("its sand differs from its hash");
    }
    return std::move(checkpoint.state);
}

void replayFurther(const fs::path& journal, std::uint64_t step, RestoredSand& restored, const Restoring& how) {
    Replay(journal, step, restored, how).run();
    restored.replayedSteps = restored.replica.stepNumber() - restored.checkpointStep;
    if (restored.replayedSteps > 0) {
        restored.state = {};
    }
}

RestoredSand restoreSand(const fs::path& journal, std::uint64_t step, const Restoring& how) {
    const std::optional<journal::JournalReader> own =
        how.opened != nullptr ? std::nullopt : std::optional(openJournal(journal));
    Restoring with = how;
    with.opened = own ? &*own : how.opened;
    const auto begun = [&] {
        return how.start != nullptr ? sand::Replica::takingHeightsOf(*how.start, how.executor)
                                    : sand::Replica(journal::sceneOf(*with.opened), how.executor);
    };
    // A checkpoint replaces this sand. Two replicas of a large field would take seconds more.
    std::optional<RestoredSand> restored(RestoredSand{begun(), 0, 0, 0, {}, {}});
    const std::int64_t volume = restored->replica.volume() + restored->replica.outflow();
    for (const std::uint64_t at : checkpointsOf(journal)) {
        if (at > std::min(step, how.newestCheckpoint)) {
            continue;
        }
        if (useCheckpoint(journal, at, with, *restored)) {
            try {
                replayFurther(journal, step, *restored, with);
                restored->volume = volume;
                return std::move(*restored);
            } catch (const OtherSand& error) {
                host::printLine("{}: it is left out: {}", checkpointFile(journal, at).string(), error.what());
                if (how.progress) {
                    how.progress(1);  // the next checkpoint is read without progress
                }
            }
        }
        restored.reset();  // before the memory for the next replica is taken
        restored.emplace(RestoredSand{begun(), 0, 0, 0, {}, {}});
    }
    restored->volume = volume;
    replayFurther(journal, step, *restored, with);
    return std::move(*restored);
}

std::optional<StoppedSession> openSession(const fs::path& journal, const std::string& scene,
                                          const std::function<void(const journal::JournalReader&)>& check) {
    std::error_code none;
    if (!fs::exists(fs::symlink_status(journal, none))) {
        return std::nullopt;
    }
    StoppedSession stopped{journal, openJournal(journal), {}, {}};
    if (check) {
        check(stopped.opened);
    }
    stopped.scene = journal::sceneOf(stopped.opened, scene::Scene::Keep::packedToo);
    stopped.check = std::make_shared<SceneCheck>(scene, stopped.scene, stopped.opened.place().journal);
    stopped.scene.material = stopped.opened.header().material.value_or(scene::Material());
    return stopped;
}

namespace {

/// Reads the records of `stopped` into `session`. Returns the newest step of a checkpoint that may be used.
std::uint64_t walk(const StoppedSession& stopped, const std::function<void(double)>& read, ResumedSession& session) {
    const fs::path& journal = stopped.journal;
    journal::JournalReader reader = openAgain(journal, stopped.opened);
    Walk walk{session, journal, {}};
    const auto all = static_cast<double>(allBytes(journal));
    try {
        while (const auto record = reader.next()) {
            std::visit(walk, *record);
            if (read) {
                read(partRead(reader, all));
            }
        }
    } catch (const base::InputError& error) {
        throw base::InputError(
            fmt::format("{}; sandwall-replay {} --recover NEW/session.journal saves the intact part, and --out NEW "
                        "--resume continues it",
                        error.what(), journal.string()));
    }
    if (read) {
        read(1);
    }
    session.place = reader.place();
    session.cutBytes = reader.tornBytes();
    return newestCheckpointFor(walk.doubted);
}

}  // namespace

ResumedState resumeSession(const StoppedSession& stopped, scene::Scene& scene, const ResumeProgress& progress,
                           const base::Executor* executor) {
    ResumedSession session;
    session.material = scene.material;
    const std::uint64_t newest = walk(stopped, progress.read, session);
    RestoredSand restored = restoreSand(stopped.journal, session.step,
                                        {.executor = executor,
                                         .start = &scene,
                                         .opened = &stopped.opened,
                                         .newestCheckpoint = newest,
                                         .keepState = true,
                                         .progress = [&](double share) {
                                             stopped.check->requireIfCompared();
                                             if (progress.replayed) {
                                                 progress.replayed(share);
                                             }
                                         }});
    session.outvoted = restored.outvoted;
    session.hash = restored.replica.stateHash();
    session.checkpointStep = restored.checkpointStep;
    session.replayedSteps = restored.replayedSteps;
    // The sand, and that before the last stroke, take about as much as the start.
    const std::size_t expected = scene.packed == nullptr ? 0 : scene.packed->size() * 9 / 4;
    base::Bytes state = restored.state.empty() ? restored.replica.encodeState(expected) : std::move(restored.state);
    session.sand = std::make_shared<sand::Replica>(std::move(restored.replica));
    return {std::move(session), std::move(state)};
}

}  // namespace master
