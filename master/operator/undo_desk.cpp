// SPDX-License-Identifier: Apache-2.0
#include "master/operator/undo_desk.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/input_error.hpp"
#include "master/journal/keeper.hpp"

namespace master {
namespace {

using Move = sand::History::Move;

std::string nothingTo(Move move) { return fmt::format("nothing to {}", nameOf(move)); }

}  // namespace

std::string_view nameOf(Move move) { return move == Move::redo ? "redo" : "undo"; }

void UndoDesk::ask(const Asked& asked) {
    if (waiting_.size() >= kMostWaiting) {
        throw base::InputError(fmt::format("{} undos and redos wait already; try again", waiting_.size()));
    }
    if (running_ || !waiting_.empty()) {
        waiting_.push_back(asked);
        return;
    }
    begin(asked);
    proceed();
}

void UndoDesk::proceed() {
    while (!running_ && !waiting_.empty()) {
        const Asked next = waiting_.front();
        waiting_.pop_front();
        try {
            begin(next);
        } catch (const base::InputError& error) {
            desk_.refuse(error.what(), {next.asker});
        }
    }
    if (running_ && running_->wanted.how.sand != nullptr && !running_->inJob) {
        copyMore();
    }
}

void UndoDesk::begin(const Asked& asked) {
    std::optional<scene::UndoHistory::Return> wanted =
        desk_.sand.history()->beginReturn(desk_.sand.replica(), asked.move);
    if (!wanted) {
        throw base::InputError(nothingTo(asked.move));
    }
    Running next{asked, std::move(*wanted)};
    if (next.wanted.how.edit == sand::Edit::undo) {
        next.number = desk_.askEdit(sand::Edit::undo, next.wanted, asked.asker);
    }
    running_ = std::move(next);
}

void UndoDesk::copyMore() {
    const sand::SurfaceCopy& copy = *running_->wanted.how.sand;
    if (!copy.complete() && !desk_.sand.replica().continueCopy(JournalKeeper::kCopiedCells)) {
        end("the sand was replaced meanwhile; try again");  // the replica was healed
    } else if (copy.complete()) {
        startJob();
    }
}

void UndoDesk::startJob() {
    try {
        desk_.jobs.requireRoom();
    } catch (const base::InputError& error) {
        end(error.what());
        return;
    }
    running_->inJob = true;
    desk_.jobs.start(
        [copy = std::exchange(running_->wanted.how.sand, nullptr), most = desk_.mostBytes,
         move = running_->asked.move]() mutable {
            base::Bytes bytes = copy->encode();
            copy.reset();  // on this thread, because a frame would wait until its memory is given back
            if (static_cast<std::int64_t>(bytes.size()) > most) {
                throw base::InputError(
                    fmt::format("{} is not possible: the sand takes {} bytes, and a step loads at most {}",
                                nameOf(move), bytes.size(), most));
            }
            return BackgroundJobs::Result{{}, sand::Edit::loaded(std::move(bytes))};
        },
        {running_->asked.asker}, BackgroundJobs::Kind::undo);
}

void UndoDesk::take(BackgroundJobs::Done done) {
    if (!running_) {
        return;
    }
    if (!done.error.empty()) {
        end(done.error);
        return;
    }
    try {
        running_->number = desk_.askEdit(std::move(done.result.edit), running_->wanted, running_->asked.asker);
    } catch (const base::InputError& error) {
        end(error.what());
    }
}

void UndoDesk::end(const std::string& why) {
    const Asker asker = running_->asked.asker;
    running_.reset();
    desk_.refuse(why, {asker});
}

std::optional<UndoDesk::Asked> UndoDesk::takeEnded(std::uint64_t number) {
    if (!running_ || number == 0 || running_->number != number) {
        return std::nullopt;
    }
    versionBefore_ = running_->wanted.how.intent.version;
    return std::exchange(running_, std::nullopt)->asked;
}

}  // namespace master
