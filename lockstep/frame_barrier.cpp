// SPDX-License-Identifier: Apache-2.0
#include "lockstep/frame_barrier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <numeric>
#include <thread>
#include <utility>

#include "host/clock.hpp"

namespace lockstep {
namespace {

enum Tag : int { kFrameTag = 10, kRestTag, kArrivalTag, kVerdictTag };

/// Message with which the master ends a frame.
struct Ending {
    Verdict verdict = Verdict::equal;
    std::int64_t quiet = 0;  // [ns], shortest time until the next frame begins
};

}  // namespace

FrameBarrier::FrameBarrier(const Cluster& cluster, std::vector<std::string> names, double limitSeconds,
                           LastWords lastWords)
    : cluster_(cluster),
      names_(std::move(names)),
      endLimit_(limitSeconds),
      arrivals_(cluster.isMaster() ? static_cast<std::size_t>(cluster.size()) : 0),
      ranks_(cluster.isMaster() ? static_cast<std::size_t>(cluster.renderRanks()) : 0),
      missing_(std::make_unique<std::atomic<bool>[]>(arrivals_.size() + 1)) {
    std::iota(ranks_.begin(), ranks_.end(), 1);
    if (cluster.isMaster()) {
        // MPI would end the job at an arrival that is too long, before the master has printed which rank sent it.
        MPI_Comm_set_errhandler(cluster.arrivals(), MPI_ERRORS_RETURN);
    }
    watchdog_ =
        std::make_unique<Watchdog>([this] { return describeWait(); }, limitSeconds, Watchdog::roleOf(cluster.rank()),
                                   [this, lastWords = std::move(lastWords)](const std::string& line) {
                                       if (lastWords) {
                                           lastWords(firstMissing(), line);
                                       }
                                   });
    cluster.startUpIsOver();
    watchdog_->arm();  // until the first frame
    wakePunctually();
}

FrameBarrier::~FrameBarrier() { cluster_.endBegins(endLimit_); }

int FrameBarrier::firstMissing() const {
    for (std::size_t rank = 1; rank < arrivals_.size(); ++rank) {
        if (missing_[rank]) {
            return static_cast<int>(rank);
        }
    }
    return -1;
}

Wait FrameBarrier::describeWait() const {
    Wait wait;
    wait.by = cluster_.rank();
    wait.frame = frame_;
    if (!cluster_.isMaster()) {
        wait.ranks = {kMaster};
        wait.names = "the master";
        wait.text = fmt::format("rank {} waits for the master after frame {}", wait.by, wait.frame);
        return wait;
    }
    for (std::size_t rank = 1; rank < arrivals_.size(); ++rank) {
        if (missing_[rank]) {
            wait.ranks.push_back(static_cast<int>(rank));
            wait.names += fmt::format("{}{}", wait.names.empty() ? "" : ", ", names_[rank]);
        }
    }
    if (wait.ranks.empty()) {
        wait.names = busyWith_.load();
    }
    wait.text = fmt::format("frame {} waits for {}", wait.frame, wait.names);
    return wait;
}

/// Returns the pauses for a wait for messages from `ranks`. They use this rank's bell if all of `ranks` can ring it.
Backoff FrameBarrier::backoffFor(std::span<const int> ranks) const {
    const HostBells& bells = cluster_.bells();
    const bool allRing = std::all_of(ranks.begin(), ranks.end(), [&](int rank) { return bells.of(rank).has_value(); });
    return Backoff(allRing ? bells.of(cluster_.rank()) : std::nullopt);
}

/// Rings the bells of `ranks`, after messages to them.
void FrameBarrier::ring(std::span<const int> ranks) const {
    for (const int rank : ranks) {
        if (const auto bell = cluster_.bells().of(rank)) {
            bell->ring();
        }
    }
}

/// Waits until all `requests` are done. `ranks` are the ranks at their other ends. `lengths` gets the length of each
/// received message [byte], or kCutShort.
void FrameBarrier::await(std::span<MPI_Request> requests, std::span<const int> ranks, Backoff backoff,
                         std::vector<int>* lengths) {
    const auto miss = [&](std::size_t which, bool missing) {
        if (cluster_.isMaster()) {
            missing_[static_cast<std::size_t>(ranks[which])] = missing;
        }
    };
    for (std::size_t i = 0; i < requests.size(); ++i) {
        miss(i, true);
    }
    for (std::size_t done = 0; done < requests.size();) {
        backoff.look();
        int which = MPI_UNDEFINED;
        int found = 0;
        MPI_Status status;
        const int error = MPI_Testany(static_cast<int>(requests.size()), requests.data(), &which, &found, &status);
        if ((found == 0 && error == MPI_SUCCESS) || which == MPI_UNDEFINED) {
            backoff.rest();
            continue;
        }
        const auto index = static_cast<std::size_t>(which);
        miss(index, false);
        backoff.found();
        ++done;
        if (lengths != nullptr) {
            int& length = (*lengths)[index] = kCutShort;
            if (error == MPI_SUCCESS) {
                MPI_Get_count(&status, MPI_BYTE, &length);
            }
        }
    }
}

void FrameBarrier::sendToAll(const void* data, std::size_t bytes, int tag) {
    std::vector<MPI_Request> requests(ranks_.size(), MPI_REQUEST_NULL);
    for (std::size_t i = 0; i < ranks_.size(); ++i) {
        MPI_Isend(data, static_cast<int>(bytes), MPI_BYTE, ranks_[i], tag, cluster_.frames(), &requests[i]);
    }
    ring(ranks_);
    await(requests, ranks_, Backoff());
}

void FrameBarrier::receiveFromMaster(void* data, std::size_t bytes, int tag) {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Irecv(data, static_cast<int>(bytes), MPI_BYTE, kMaster, tag, cluster_.frames(), &request);
    // NOLINTNEXTLINE(clang-analyzer-optin.mpi.MPI-Checker): await() waits for it
    await({&request, 1}, {&kMaster, 1}, backoffFor({&kMaster, 1}));
}

FrameMessage FrameBarrier::begin(FrameMessage fromMaster, std::size_t& bytes) {
    const Watched watched(*watchdog_);
    std::array<std::uint8_t, kOneMessage> packet{};
    constexpr std::size_t kRoom = kOneMessage - sizeof(std::uint32_t);
    base::Bytes message;
    std::uint32_t length = 0;
    if (cluster_.isMaster()) {
        frame_ = fromMaster.frame;
        message = base::encoded(fromMaster);
        length = static_cast<std::uint32_t>(message.size());
        std::memcpy(packet.data(), &length, sizeof length);
        const std::size_t first = std::min(message.size(), kRoom);
        std::copy_n(message.begin(), first, packet.begin() + sizeof length);
        sendToAll(packet.data(), sizeof length + first, kFrameTag);
        for (std::uint64_t done = kRoom; done < length; done += kMpiPiece) {  // a long catch-up, or a load
            sendToAll(message.data() + done, std::min(kMpiPiece, length - done), kRestTag);
        }
        bytes = length;
        return fromMaster;
    }
    std::this_thread::sleep_until(std::chrono::steady_clock::time_point(std::chrono::nanoseconds(quietUntil_)));
    receiveFromMaster(packet.data(), packet.size(), kFrameTag);
    std::memcpy(&length, packet.data(), sizeof length);
    message.resize(length);
    std::copy_n(packet.begin() + sizeof length, std::min<std::size_t>(length, kRoom), message.begin());
    for (std::uint64_t done = kRoom; done < length; done += kMpiPiece) {
        receiveFromMaster(message.data() + done, std::min(kMpiPiece, length - done), kRestTag);
    }
    bytes = length;
    return base::decoded<FrameMessage>(message);
}

void FrameBarrier::carryPointers() {
    pointer_.emplace();
    pointers_.resize(arrivals_.size());
}

/// Receives all arrivals at the master, and lists the ranks that sent something else.
void FrameBarrier::receiveArrivals(std::uint64_t frame) {
    std::vector<std::array<std::uint8_t, kArrivalRoom>> letters(ranks_.size());
    std::vector<MPI_Request> requests(ranks_.size(), MPI_REQUEST_NULL);
    std::vector<int> lengths(ranks_.size());
    for (std::size_t i = 0; i < ranks_.size(); ++i) {
        MPI_Irecv(letters[i].data(), static_cast<int>(kArrivalRoom), MPI_BYTE, ranks_[i], kArrivalTag,
                  cluster_.arrivals(), &requests[i]);
    }
    await(requests, ranks_, backoffFor(ranks_), &lengths);
    nonsense_.clear();
    for (std::size_t i = 0; i < ranks_.size(); ++i) {
        Arrival& arrival = arrivals_[i + 1];
        try {
            arrival = readArrival(letters[i], lengths[i], frame, pointer_ ? &pointers_[i + 1] : nullptr);
        } catch (const base::FormatError& error) {
            nonsense_.push_back({ranks_[i], fmt::format("frame {}: {} sent an invalid arrival ({})", frame,
                                                        names_[i + 1], error.what())});
            arrival = {.frame = frame};
            if (pointer_) {
                pointers_[i + 1] = {};
            }
        }
    }
}

/// Rings before it waits, because Open MPI completes a letter of more than 256 bytes only when the master has taken it.
void FrameBarrier::sendArrival(const Arrival& mine) {
    base::Bytes letter;
    if (std::exchange(garbles_, false)) {
        letter = noiseForArrival(mine.frame);
    } else {
        letter.resize(sizeof mine + (pointer_ ? sizeof *pointer_ : 0));
        std::memcpy(letter.data(), &mine, sizeof mine);
        if (pointer_) {
            std::memcpy(letter.data() + sizeof mine, &*pointer_, sizeof *pointer_);
        }
    }
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Isend(letter.data(), static_cast<int>(letter.size()), MPI_BYTE, kMaster, kArrivalTag, cluster_.arrivals(),
              &request);
    ring({&kMaster, 1});
    // NOLINTNEXTLINE(clang-analyzer-optin.mpi.MPI-Checker): await() waits for it
    await({&request, 1}, {&kMaster, 1}, Backoff());
}

Verdict FrameBarrier::meet(const Arrival& mine, std::int64_t nextFrame) {
    const Watched watched(*watchdog_);
    frame_ = mine.frame;
    Ending ending;
    if (cluster_.isMaster()) {
        arrivals_[kMaster] = mine;
        receiveArrivals(mine.frame);
        const auto differs = [&](auto hash) {
            return std::any_of(arrivals_.begin(), arrivals_.end(),
                               [&](const Arrival& arrival) { return arrival.*hash != mine.*hash; });
        };
        const bool otherSand = differs(&Arrival::stateHash) || differs(&Arrival::movement);
        ending.verdict = !nonsense_.empty()            ? Verdict::nonsense
                         : otherSand                   ? Verdict::otherSand
                         : differs(&Arrival::viewHash) ? Verdict::otherView
                                                       : Verdict::equal;
        ending.quiet = std::max<std::int64_t>(0, nextFrame - host::monotonicNs());
        sendToAll(&ending, sizeof ending, kVerdictTag);
    } else {
        sendArrival(mine);
        receiveFromMaster(&ending, sizeof ending, kVerdictTag);
        quietUntil_ = host::monotonicNs() + ending.quiet;
    }
    watchdog_->startUpIsOver();
    return ending.verdict;
}

}  // namespace lockstep
