// SPDX-License-Identifier: Apache-2.0
// What a session writes to its journal, and how it goes on when the disk refuses.
#include <fmt/format.h>

#include "base/input_error.hpp"
#include "host/build_id.hpp"
#include "master/session.hpp"
#include "scene/scene.hpp"

namespace master {
namespace {

constexpr std::int64_t kFrameBytes = 1 << 16;  // more than the steps of a frame, but for sand that is loaded

std::int64_t sandBytes(const sand::Edit& edit) { return edit.sand ? static_cast<std::int64_t>(edit.sand->size()) : 0; }

}  // namespace

void Session::beginJournal(const scene::Scene& scene) {
    const ResumedSession* resumed = options_.resumed.get();
    if (resumed != nullptr) {
        terrain_.decodeState(resumed->state);
        material_ = resumed->material;
        frame_ = summary_.framesBefore = resumed->frame;
        summary_.edits = resumed->edits;
    }
    journal_.emplace(options_.out, options_.journal, scene, resumed, options_.failure.what, host::buildId());
}

void Session::tellRecovery() {
    if (!options_.resumed || lastSwap_ != 0) {
        return;
    }
    const ResumedSession& resumed = *options_.resumed;
    master::tellRecovery({options_.failure, terrain_.stepNumber(), frame_, hash_, resumed.checkpointStep,
                          resumed.replayedSteps, resumed.cutBytes},
                         options_.out);
}

bool Session::mayTakeSteps(const sand::Edit& more) {
    std::int64_t bytes = kFrameBytes + sandBytes(more);
    for (const Asker& asker : askers_) {
        bytes += sandBytes(asker.edit);
    }
    standing_ = journal_ && !journal_->mayTake(bytes, {terrain_.stepNumber(), hash_});
    if (standing_) {
        tellWhoWaitsForRoom();
    }
    return !standing_;
}

void Session::keepJournal(const JournalFrame& frame) {
    if (!journal_) {
        return;
    }
    const lockstep::Busy busy(barrier_, "the disk of its journal");
    std::vector<scene::Material> materials;
    for (const sand::Step& step : frame.steps) {
        for (const Asker& asker : askers_) {
            if (asker.material && asker.edit == step.edit) {
                materials.push_back(*asker.material);
                break;
            }
        }
    }
    try {
        journal_->keep(frame, materials);
    } catch (const DiskFailure& failure) {
        endForDisk(failure);
    }
}

void Session::keepTicks() {
    const std::vector<base::Bytes> pieces = liveSteps_.ticks();
    try {
        if (journal_) {
            journal_->keepTicks(pieces);
        }
    } catch (const DiskFailure& failure) {
        endForDisk(failure);
    }
}

void Session::endForDisk(const DiskFailure& failure) {
    const std::string message = fmt::format(
        "{}, which is not shown: the session ends (--journal best-effort would go on without)", failure.what());
    (void)writeFailure(failureOf("disk", lockstep::kMaster, message), options_.out);
    throw DiskFailure(message);
}

void Session::endJournal(bool agreed) {
    if (!journal_) {
        return;
    }
    if (agreed) {
        journal_->finish({terrain_.stepNumber(), hash_});
    }
    Summary::Journal& told = summary_.journal;
    told.policy = journalPolicyName(journal_->policy());
    told.state = journal_->state();
    told.parts = journal_->parts();
    told.checkpointsFailed = journal_->checkpointsFailed();
    told.checkpointsBeyond = journal_->checkpointsBeyond();
    told.stands = journal_->stands();
    told.stoodSeconds = journal_->stoodSeconds();
    for (const double ms : journal_->copyMs()) {
        told.checkpointMs.add(ms);
    }
}

}  // namespace master
