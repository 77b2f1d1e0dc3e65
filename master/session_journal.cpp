// SPDX-License-Identifier: Apache-2.0
// What a session writes to its journal, and how it goes on when the disk refuses.
#include <fmt/format.h>

#include <cstdio>

#include "files/input_error.hpp"
#include "master/session.hpp"

namespace master {

void Session::keepJournal(const JournalFrame& frame) {
    try {
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
