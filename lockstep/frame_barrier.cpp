// SPDX-License-Identifier: Apache-2.0
#include "lockstep/frame_barrier.hpp"

#include <fmt/format.h>
#include <sched.h>

#include <algorithm>

namespace lockstep {
namespace {

constexpr int kTag = 2;
constexpr int kArrivalBytes = static_cast<int>(sizeof(Arrival));

}  // namespace

FrameBarrier::FrameBarrier(const Cluster& cluster, std::vector<std::string> names, double limitSeconds)
    : cluster_(cluster),
      names_(std::move(names)),
      arrivals_(cluster.isMaster() ? static_cast<std::size_t>(cluster.size()) : 0),
      receives_(arrivals_.size(), MPI_REQUEST_NULL),
      missing_(std::make_unique<std::atomic<bool>[]>(arrivals_.size() + 1)) {
    // One voice is enough: the master names the missing; if it is silent itself, the first rank says so.
    watchdog_ = std::make_unique<Watchdog>([this] { return describeWait(); }, limitSeconds, cluster.rank() <= 1);
}

FrameBarrier::~FrameBarrier() = default;

std::string FrameBarrier::describeWait() const {
    if (!cluster_.isMaster()) {
        return fmt::format("rank {} waits for the master after frame {}", cluster_.rank(), frame_.load());
    }
    std::string who;
    for (std::size_t rank = 1; rank < arrivals_.size(); ++rank) {
        if (missing_[rank]) {
            who += fmt::format("{}{}", who.empty() ? "" : ", ", names_[rank]);
        }
    }
    return fmt::format("frame {} waits for {}", frame_.load(), who.empty() ? "the barrier" : who);
}

void FrameBarrier::collectArrivals(std::uint64_t frame) {
    for (std::size_t rank = 1; rank < arrivals_.size(); ++rank) {
        missing_[rank] = true;
        MPI_Irecv(&arrivals_[rank], kArrivalBytes, MPI_BYTE, static_cast<int>(rank), kTag, cluster_.arrivals(),
                  &receives_[rank]);
    }
    frame_ = frame;
    for (std::size_t here = 1; here < arrivals_.size();) {
        int which = MPI_UNDEFINED;
        int done = 0;
        MPI_Testany(static_cast<int>(receives_.size()), receives_.data(), &which, &done, MPI_STATUS_IGNORE);
        if (done != 0 && which != MPI_UNDEFINED) {
            missing_[static_cast<std::size_t>(which)] = false;
            ++here;
        } else {
            sched_yield();  // whoever draws on this core goes first
        }
    }
}

bool FrameBarrier::meet(const Arrival& mine) {
    const Watched watched(*watchdog_);
    int equal = 0;
    if (cluster_.isMaster()) {
        arrivals_[kMaster] = mine;
        collectArrivals(mine.frame);
        equal = std::all_of(arrivals_.begin(), arrivals_.end(),
                            [&](const Arrival& arrival) { return arrival.stateHash == mine.stateHash; })
                    ? 1
                    : 0;
    } else {
        frame_ = mine.frame;
        MPI_Send(&mine, kArrivalBytes, MPI_BYTE, kMaster, kTag, cluster_.arrivals());
    }
    MPI_Bcast(&equal, 1, MPI_INT, kMaster, cluster_.frames());
    watchdog_->startUpIsOver();
    return equal != 0;
}

}  // namespace lockstep
