// SPDX-License-Identifier: Apache-2.0
// Waits of the start, which continue as long as progress comes.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/clock.hpp"
#include "lockstep/backoff.hpp"
#include "lockstep/cluster.hpp"

namespace lockstep {
namespace {

enum StartTag : int { kStartTag = 40, kRankProgressTag };

constexpr double kProgress = 0.01;                 // a smaller part of some work does not count
constexpr std::int64_t kPassOnNs = 1'000'000'000;  // least time between two notes to ranks that wait for others

/// Receives the next note of the master. Sleeps meanwhile, because the master and the haptic server need the cores.
template <class Note>
Note receiveNote(MPI_Comm frames) {
    Note note{};
    MPI_Request request{};
    MPI_Irecv(&note, 1, MPI_BYTE, kMaster, kStartTag, frames, &request);
    int received = 0;
    for (Backoff backoff; MPI_Test(&request, &received, MPI_STATUS_IGNORE), received == 0;) {
        backoff.rest();
    }
    return note;
}

}  // namespace

void Cluster::progress(const char* work, double share) const {
    const bool same = ownWork_ == work;
    if (same && share < progress_ + kProgress) {
        return;
    }
    progress_ = share;
    ownWork_ = work;
    send(StartNote::progress);
    mayTakeLong(false);
}

void Cluster::progressEnds() const {
    if (ownWork_ != nullptr) {
        ownWork_ = nullptr;
        send(StartNote::quiet);
        mayTakeLong(true);
    }
}

/// Sends a note to the render ranks, which wait in awaitBroadcast() or agree(). The messages are short, so that MPI
/// keeps them for ranks that do not receive yet.
void Cluster::send(StartNote note) const {
    for (int rank = 1; rank < size_; ++rank) {
        send(note, rank);
    }
}

void Cluster::send(StartNote note, int rank) const { MPI_Send(&note, 1, MPI_BYTE, rank, kStartTag, frames_); }

void Cluster::awaitBroadcast() const {
    if (isMaster()) {
        ownWork_ = nullptr;
        send(StartNote::broadcast);
    }
    for (auto note = StartNote::quiet; note != StartNote::broadcast && !isMaster();) {
        note = receiveNote<StartNote>(frames_);
        mayTakeLong(note != StartNote::progress);
    }
}

void Cluster::rankProgress(double share) const {
    if (share < progress_ + kProgress) {
        return;
    }
    progress_ = share;
    MPI_Send(&share, 1, MPI_DOUBLE, kMaster, kRankProgressTag, frames_);
    watchdog_->arm();
}

/// Receives the progress of ranks, and forwards it to the ranks that are ready and wait.
void Cluster::takeRankProgress(const std::function<void(double)>& made) const {
    bool further = false;
    while (true) {
        int found = 0;
        MPI_Status status{};
        MPI_Iprobe(MPI_ANY_SOURCE, kRankProgressTag, frames_, &found, &status);
        if (found == 0) {
            break;
        }
        double share = 0;
        MPI_Recv(&share, 1, MPI_DOUBLE, status.MPI_SOURCE, kRankProgressTag, frames_, MPI_STATUS_IGNORE);
        rankShares_.at(static_cast<std::size_t>(status.MPI_SOURCE)) = share;
        further = true;
    }
    if (further) {
        watchdog_->arm();
        if (made) {
            made(std::accumulate(rankShares_.begin() + 1, rankShares_.end(), 0.0) / renderRanks());
        }
    }
    const std::int64_t now = host::monotonicNs();
    if (!further || now - passedOn_ < kPassOnNs) {
        return;
    }
    passedOn_ = now;
    for (int rank = 1; rank < size_; ++rank) {
        if (!missing_[static_cast<std::size_t>(rank)]) {
            send(StartNote::progress, rank);
        }
    }
}

std::vector<base::Bytes> Cluster::gatherReady(const base::Bytes& mine, const std::function<void(double)>& made) const {
    if (!isMaster()) {
        return gather(mine);
    }
    ownWork_ = nullptr;
    rankShares_.assign(static_cast<std::size_t>(size_), 0.0);
    watchdog_->arm();  // the master's own work has ended, and its wait for the ranks begins
    return gather(mine, [this, &made] { takeRankProgress(made); });
}

bool Cluster::agree(bool master) const {
    if (isMaster()) {
        send(master ? StartNote::begin : StartNote::refuse);
        return master;
    }
    for (auto note = StartNote::progress;; watchdog_->arm()) {
        note = receiveNote<StartNote>(frames_);
        if (note == StartNote::begin || note == StartNote::refuse) {
            return note == StartNote::begin;
        }
    }
}

}  // namespace lockstep
