// SPDX-License-Identifier: Apache-2.0
#include "master/journal/keeper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include "base/input_error.hpp"
#include "host/event.hpp"
#include "host/print_line.hpp"
#include "host/whole_file.hpp"
#include "master/journal/file_parts.hpp"
#include "scene/model/scene.hpp"

namespace master {
namespace {

constexpr double kRetrySeconds = 1;
constexpr const char* kBeyond = ".beyond";   // behind the name of a checkpoint that was set aside
constexpr std::size_t kCheckpointsKept = 3;  // the newest two may be damaged

// The longest time that the ranks wait for a checkpoint at the end.
constexpr std::chrono::milliseconds kHeldRanks{500};

bool hasSetAside(const std::filesystem::path& checkpoints) {
    std::error_code none;
    const std::filesystem::directory_iterator files(checkpoints, none);
    return std::any_of(begin(files), end(files), [](const auto& file) { return file.path().extension() == kBeyond; });
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

JournalKeeper::JournalKeeper(const std::filesystem::path& out, const JournalOptions& options, const scene::Scene& scene,
                             const ResumedSession* resumed, const std::string& failure, std::string buildId)
    : options_(options),
      journal_(out / "session.journal"),
      buildId_(std::move(buildId)),
      sceneDigest_(scene.rules.digest()),
      lastCheckpoint_(now()) {
    if (options_.policy == JournalPolicy::off) {
        requireNoWriter();
        keepPreviousJournal(journal_);  // otherwise it would be taken for this session's journal
        return;
    }
    if (resumed == nullptr) {
        requireNoWriter();
        std::error_code none;  // ignored, because the folder need not exist
        const std::filesystem::path old = checkpointFile(journal_, 0).parent_path();
        if (std::filesystem::is_directory(std::filesystem::symlink_status(old, none))) {
            std::filesystem::remove_all(old, none);
        }
        writer_.emplace(journal_, scene, buildId_, options_.partBytes);
        return;
    }
    try {
        writer_.emplace(resumed->place, buildId_, options_.partBytes);
        writer_->resume({resumed->frame, {resumed->step, resumed->hash}, resumed->cutBytes, failure});
    } catch (const std::runtime_error& error) {
        refused(error.what());
        return;
    }
    setAside(resumed->step);
    checkpointStep_ = resumed->checkpointStep;
    // Makes a checkpoint at once, because repeated crashes must not make each replay longer.
    lastCheckpoint_ -= options_.checkpointSeconds;
}

JournalKeeper::~JournalKeeper() {
    if (checkpoint_ && !checkpoint_->endsWithin(UnfinishedCheckpoint::kPatience)) {
        checkpoint_->leaveOut();
    }
    takeCheckpoint(true);
}

void JournalKeeper::requireNoWriter() const {
    std::uint32_t last = 1;
    for (std::error_code none; std::filesystem::exists(partOf(journal_, last + 1), none);) {
        ++last;
    }
    PartFile::requireNoWriter(partOf(journal_, last));
}

void JournalKeeper::refused(const std::string& why) {
    writer_.reset();
    if (options_.policy == JournalPolicy::required) {
        throw std::runtime_error(why);  // not an InputError, because a later try may succeed
    }
    host::printLine("{}; the session continues without a journal", why);
    host::emitEvent("journal", {{"state", "failed"}, {"error", why}});
}

void JournalKeeper::setAside(std::uint64_t step) {
    for (const std::uint64_t later : checkpointsOf(journal_)) {
        const std::filesystem::path file = checkpointFile(journal_, later);
        const std::filesystem::path aside = file.string() + kBeyond;
        std::error_code error;
        if (later > step) {
            // The session will make this step again, differently, and the checkpoint would be taken for its sand. It is
            // renamed and not removed, because the journal has lost this sand.
            std::filesystem::rename(file, aside, error);
            ++checkpointsBeyond_;
            host::printLine("{}: kept as {}: the journal ends before it, at step {}", file.string(),
                            aside.filename().string(), step);
        }
    }
    lostSteps_ = hasSetAside(checkpointFile(journal_, step).parent_path());
    forgetHalves(journal_);
    (void)host::syncFolderOf(
        checkpointFile(journal_, step));  // the checkpoint must not come back after a loss of power
}

std::string_view JournalKeeper::state() const {
    return stopped_ ? "no_room" : writer_ ? "written" : options_.policy == JournalPolicy::off ? "off" : "failed";
}

bool JournalKeeper::hasRoom(std::int64_t bytes, const journal::JournalEnd& sand) {
    std::string why;
    if (writer_->makeRoom(bytes, sand, why) != JournalWriter::Room::none) {
        return true;
    }
    if (options_.policy != JournalPolicy::required) {
        return true;  // if the disk then refuses the steps, the journal ends
    }
    if (!stopped_) {
        host::printLine(
            "the disk has no room for the journal ({}); the sand is stopped after step {} until there is room", why,
            sand.step);
        host::emitEvent("journal", {{"state", "no_room"}, {"step", sand.step}, {"error", why}});
        stopped_ = true;
        stoppedSince_ = now();
        ++stops_;
    }
    return false;
}

bool JournalKeeper::mayTake(std::int64_t bytes, const journal::JournalEnd& sand) {
    if (!writer_) {
        return true;
    }
    if (stopped_ && now() - lastTry_ < kRetrySeconds) {
        return false;
    }
    lastTry_ = now();
    const bool room = hasRoom(bytes + (stopped_ ? kResumeBytes : 0), sand);
    if (room && stopped_) {
        const double seconds = now() - stoppedSince_;
        host::printLine("the disk has room for the journal again; the sand continues after {:.0f} s", seconds);
        host::emitEvent("journal", {{"state", "room"}, {"seconds", seconds}});
        stoppedSeconds_ += seconds;
        stopped_ = false;
    }
    return room;
}

bool JournalKeeper::hasRoomFor(std::int64_t bytes, const journal::JournalEnd& sand) {
    if (!writer_ || options_.policy != JournalPolicy::required) {
        return true;
    }
    std::string why;
    return !stopped_ && writer_->makeRoom(bytes, sand, why) != JournalWriter::Room::none;
}

void JournalKeeper::giveUp(const std::string& why) {
    writer_.reset();
    if (options_.policy == JournalPolicy::required) {
        throw DiskFailure(why);
    }
    host::printLine("{}; the session continues without a journal", why);
    host::emitEvent("journal", {{"state", "failed"}, {"error", why}});
}

void JournalKeeper::keep(const journal::JournalFrame& frame, const std::vector<scene::Material>& materials) {
    if (!writer_) {
        return;
    }
    try {
        for (const scene::Material& material : materials) {
            writer_->keep(material);
        }
        writer_->append(frame);
    } catch (const base::InputError& error) {
        giveUp(fmt::format("{}; it ends before frame {}", error.what(), frame.frame));
    }
}

void JournalKeeper::keepTicks(const std::vector<base::Bytes>& pieces) {
    for (const base::Bytes& piece : pieces) {
        try {
            if (writer_ && !writer_->keep(journal::JournalTicks{piece}) && !std::exchange(ticksLeftOut_, true)) {
                host::printLine("the disk has no room for the tick track; ticks are left out until there is room");
            }
        } catch (const base::InputError& error) {
            giveUp(error.what());
        }
    }
}

void JournalKeeper::note(const journal::JournalRecord& record) {
    try {
        if (writer_) {
            (void)writer_->keep(record);
            writer_->writeIfRoom();
        }
    } catch (const base::InputError& error) {
        giveUp(error.what());
    }
}

void JournalKeeper::doubt(const journal::JournalDoubt& doubt) {
    doubted_ = true;
    note(doubt);
}

void JournalKeeper::checked(const journal::JournalChecked& checked) {
    doubted_ = false;
    note(checked);
    lastCheckpoint_ -= options_.checkpointSeconds;
}

void JournalKeeper::force(const journal::JournalForce& force) { note(force); }

/// Takes the result of a checkpoint if it has been written, or waits for it.
void JournalKeeper::takeCheckpoint(bool wait) {
    if (!checkpoint_ || (!wait && !checkpoint_->endsWithin({}))) {
        return;
    }
    const std::string complaint = checkpoint_->complaint();
    checkpoint_.reset();
    checkpointsFailed_ += complaint.empty() ? 0 : 1;
    if (!complaint.empty() && complaint != complaint_) {  // printed once, even if it repeats
        host::printLine("{}; no checkpoint was written, and the session continues", complaint);
    }
    complaint_ = complaint;
}

void JournalKeeper::shown(const sand::Replica& replica, std::uint64_t frame, std::uint32_t epoch, std::uint64_t hash) {
    takeCheckpoint(false);
    if (begun_) {
        continueCopy(replica, kCopiedCells);
        return;
    }
    const bool due = options_.checkpointSeconds > 0 && now() - lastCheckpoint_ >= options_.checkpointSeconds;
    if (!writer_ || !due || doubted_ || checkpoint_ || replica.stepNumber() == checkpointStep_) {
        return;
    }
    lastCheckpoint_ = now();
    checkpointStep_ = replica.stepNumber();
    copyMs_.push_back(0);
    begun_.emplace(Begun{{writer_->session(), buildId_, sceneDigest_, checkpointStep_, frame, epoch, hash, {}},
                         replica.beginCopy()});
    continueCopy(replica, kCopiedCells);
    copyMs_.back() = 1e3 * (now() - lastCheckpoint_);
}

/// Copies `cells` cells of a begun checkpoint, and lets a thread write it when its copy is complete.
void JournalKeeper::continueCopy(const sand::Replica& replica, std::int64_t cells) {
    const double begin = now();
    const bool copied = !begun_->copy.complete() && replica.continueCopy(cells);
    if (begun_->copy.complete()) {
        writeInBackground();
    } else if (!copied) {
        begun_.reset();  // another replica has taken the place of the one that was copied
    }
    copyMs_.back() = std::max(copyMs_.back(), 1e3 * (now() - begin));
}

void JournalKeeper::writeInBackground() {
    checkpoint_.emplace(checkpointStep_, [begun = std::make_shared<const Begun>(std::move(*begun_)),
                                          journal = journal_](UnfinishedCheckpoint::Work& work) {
        writeCheckpoint(journal, begun->checkpoint, begun->copy, kCheckpointsKept, [&work](double share) {
            work.setDone(share);
            work.requireWanted();
        });
    });
    begun_.reset();
}

void JournalKeeper::copyRest(const sand::Replica& replica) {
    if (begun_) {
        continueCopy(replica, std::numeric_limits<std::int64_t>::max());
    }
}

std::optional<UnfinishedCheckpoint> JournalKeeper::takeUnfinished() { return std::exchange(checkpoint_, std::nullopt); }

bool JournalKeeper::hasCheckpoint() const { return !checkpointsOf(journal_).empty(); }

double JournalKeeper::stoppedSeconds() const { return stoppedSeconds_ + (stopped_ ? now() - stoppedSince_ : 0); }

void JournalKeeper::finish(const journal::JournalEnd& end) {
    if (checkpoint_ && checkpoint_->endsWithin(kHeldRanks)) {
        takeCheckpoint(true);
    }
    try {
        if (writer_ && doubted_) {
            writer_->sync();
        } else if (writer_) {
            writer_->finish(end.step, end.hash);
            ended_ = true;
        }
    } catch (const base::InputError& error) {
        host::printLine("{}; it holds every step, and no end", error.what());
    }
}

}  // namespace master
