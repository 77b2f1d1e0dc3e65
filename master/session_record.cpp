// SPDX-License-Identifier: Apache-2.0
#include "master/session_record.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "host/build_id.hpp"
#include "host/print_line.hpp"
#include "host/regular_file.hpp"
#include "master/pictures/film.hpp"

namespace master {
namespace {

constexpr std::int64_t kFrameBytes = 1 << 16;  // [byte], more than the steps of a frame take, without loaded sand

/// Removes the results of an earlier session, so that they are never taken for results of this one.
void forgetOldResults(const std::filesystem::path& folder, bool resumed) {
    if (!resumed) {
        host::forgetFile(folder / "divergence.txt");
        forgetRecoveries(folder);
    }
    for (const char* name :
         {"summary.json", "failure.json", "wall.png", "wall_left.png", "wall_right.png", "wall_anaglyph.png"}) {
        host::forgetFile(folder / name);
    }
    std::vector<std::filesystem::path> tiles;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("tile_") && name.ends_with(".png")) {
            tiles.push_back(entry.path());
        }
    }
    for (const std::filesystem::path& tile : tiles) {
        host::forgetFile(tile);
    }
    Film::forget(folder);
}

journal::JournalEnd endOf(const MasterSand& sand) { return {sand.replica().stepNumber(), sand.hash()}; }

}  // namespace

SessionRecord::SessionRecord(std::filesystem::path out, RecordOptions options, const scene::Scene& scene,
                             RankLabels labels)
    : out_(std::move(out)),
      options_(std::move(options)),
      labels_(std::move(labels)),
      incidents_(out_, options_.resumed != nullptr),
      recoveries_(out_) {
    if (options_.keepsJournal) {
        journal_.emplace(out_, options_.journal, scene, options_.resumed.get(), withoutHosts(options_.failure),
                         host::buildId());
    }
    forgetOldResults(out_, options_.resumed != nullptr);
    if (!options_.resumed) {
        incidents_.forget();
    }
}

bool SessionRecord::hasRoom(std::int64_t bytes, const MasterSand& sand) {
    full_ = journal_ && !journal_->mayTake(kFrameBytes + bytes, endOf(sand));
    return !full_;
}

bool SessionRecord::hasRoomForEdit(std::int64_t bytes, const MasterSand& sand) {
    return !journal_ || journal_->hasRoomFor(kFrameBytes + bytes, endOf(sand));
}

template <class Write>
void SessionRecord::onDisk(const Write& write) {
    if (!journal_) {
        return;
    }
    try {
        write(*journal_);
    } catch (const DiskFailure& failure) {
        endForDisk(failure);
    }
}

void SessionRecord::keep(const journal::JournalFrame& frame, const std::vector<scene::Material>& materials) {
    onDisk([&](JournalKeeper& journal) { journal.keep(frame, materials); });
}

void SessionRecord::keepTicks(const std::vector<base::Bytes>& pieces) {
    onDisk([&](JournalKeeper& journal) { journal.keepTicks(pieces); });
}

void SessionRecord::doubt(const journal::JournalDoubt& doubt) {
    onDisk([&](JournalKeeper& journal) { journal.doubt(doubt); });
}

void SessionRecord::checked(const journal::JournalChecked& checked) {
    onDisk([&](JournalKeeper& journal) { journal.checked(checked); });
}

void SessionRecord::keepForce(double share) {
    onDisk([&](JournalKeeper& journal) { journal.force({share}); });
}

void SessionRecord::endForDisk(const DiskFailure& failure) const {
    const std::string line = fmt::format(
        "{}, which is not shown; the session ends (with --journal best-effort it would continue)", failure.what());
    (void)writeFailure(labels_.failure("disk", lockstep::kMaster, line), out_);
    throw DiskFailure(line);
}

void SessionRecord::shown(const Swap& swap, std::uint64_t frame, const MasterSand& sand, std::uint32_t epoch) {
    if (swap.first && options_.resumed) {
        reportRecovery(frame, sand);
    }
    if (journal_) {
        journal_->shown(sand.replica(), frame, epoch, sand.hash());
    }
}

void SessionRecord::reportRecovery(std::uint64_t frame, const MasterSand& sand) const {
    const ResumedSession& resumed = *options_.resumed;
    master::reportRecovery({options_.failure, sand.replica().stepNumber(), frame, sand.hash(), resumed.checkpointStep,
                            resumed.replayedSteps, resumed.cutBytes},
                           out_);
}

void SessionRecord::finish(const MasterSand& sand, bool agreed) {
    if (journal_ && agreed) {
        journal_->copyRest(sand.replica());
        journal_->finish(endOf(sand));
    }
}

std::optional<UnfinishedCheckpoint> SessionRecord::takeUnfinished() {
    return journal_ ? journal_->takeUnfinished() : std::nullopt;
}

std::filesystem::path SessionRecord::journalFile() const {
    // If this session writes no journal, a journal in the folder belongs to another session or ends too early.
    return journal_ && journal_->written() ? out_ / "session.journal" : std::filesystem::path();
}

std::unique_ptr<sand::Replica> SessionRecord::sandOfJournal(const MasterSand& sand,
                                                            const base::Executor* executor) const {
    const std::filesystem::path file = journalFile();
    if (file.empty()) {
        return nullptr;
    }
    try {
        return std::make_unique<sand::Replica>(
            restoreSand(file, sand.replica().stepNumber(), {.executor = executor}).replica);
    } catch (const std::exception& error) {  // caught, because the ranks wait for an answer
        host::printLine("{}", error.what());
        return nullptr;
    }
}

void SessionRecord::describe(nlohmann::json& status) const {
    status["journal"] = journal_ && journal_->written();
    status["journal_policy"] = std::string(base::nameOf(options_.journal.policy));
    status["journal_state"] = std::string(journal_ ? journal_->state() : "off");
    status["checkpoints_failed"] = journal_ ? journal_->checkpointsFailed() : 0;
    status["restarts"] = recoveries_.count();
}

Summary::Journal SessionRecord::summary() const {
    Summary::Journal result;
    if (!journal_) {
        return result;
    }
    result.policy = base::nameOf(journal_->policy());
    result.state = journal_->state();
    result.parts = journal_->parts();
    result.checkpointsFailed = journal_->checkpointsFailed();
    result.checkpointsBeyond = journal_->checkpointsBeyond();
    result.whole = journal_->whole();
    result.stoppedSeconds = journal_->stoppedSeconds();
    for (const double ms : journal_->copyMs()) {
        result.checkpointMs.add(ms);
    }
    return result;
}

}  // namespace master
