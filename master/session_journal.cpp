// SPDX-License-Identifier: Apache-2.0
// What a session writes to its journal, and how it goes on when the disk refuses.
#include <fmt/format.h>

#include <cstdio>

#include "files/input_error.hpp"
#include "lockstep/build_id.hpp"
#include "master/session.hpp"

namespace master {

void Session::beginJournal(const sand::Scene& scene) {
    const std::filesystem::path file = options_.out / "session.journal";
    if (!options_.resumed) {
        journal_.emplace(file, scene, lockstep::buildId());
        return;
    }
    const ResumedSession& resumed = *options_.resumed;
    terrain_.decodeState(resumed.state);
    material_ = resumed.material;
    frame_ = summary_.framesBefore = resumed.frame;
    summary_.edits = resumed.edits;
    journal_.emplace(resumed.place, lockstep::buildId());
    journal_->resume({resumed.frame, {resumed.step, resumed.hash}, resumed.cutBytes, options_.failure.what});
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

void Session::keepJournal(const JournalFrame& frame) {
    try {
        for (const sand::Step& step : frame.steps) {
            for (const Asker& asker : askers_) {
                if (asker.material && asker.edit == step.edit) {
                    journal_->keepMaterial(*asker.material);
                    break;
                }
            }
        }
        journal_->append(frame);
    } catch (const files::InputError& error) {
        // A full disk must not end a show; what is missing can be seen from the journal itself, which has no end.
        fmt::print(stderr, "sandwall: {}; it ends before frame {}, and the session goes on without\n", error.what(),
                   frame.frame);
        journal_.reset();
    }
}

void Session::keepTicks() {
    for (const files::Bytes& piece : sequencer_.ticks()) {
        try {
            if (journal_) {
                journal_->keepTicks(piece);
            }
        } catch (const files::InputError& error) {
            fmt::print(stderr, "sandwall: {}; the session goes on without\n", error.what());
            journal_.reset();
        }
    }
}

void Session::endJournal() {
    try {
        if (journal_) {
            journal_->finish(terrain_.stepNumber(), hash_);
        }
    } catch (const files::InputError& error) {
        fmt::print(stderr, "sandwall: {}; it holds every step, and no end\n", error.what());
    }
}

}  // namespace master
