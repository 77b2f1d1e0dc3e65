// SPDX-License-Identifier: Apache-2.0
#include "lockstep/frame_barrier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>

#include "lockstep/patience.hpp"

namespace lockstep {
namespace {

enum Tag : int { kFrameTag = 10, kRestTag, kArrivalTag, kVerdictTag };
constexpr int kArrivalBytes = static_cast<int>(sizeof(Arrival));

/// How the master ends a frame.
struct Ending {
    Verdict verdict = Verdict::equal;
    std::int64_t quiet = 0;  // for so long at least no frame will begin [ns]
};

Watchdog::Role roleOf(const Cluster& cluster) {
    return cluster.isMaster()    ? Watchdog::Role::master
           : cluster.rank() == 1 ? Watchdog::Role::firstRank
                                 : Watchdog::Role::otherRank;
}

}  // namespace

FrameBarrier::FrameBarrier(const Cluster& cluster, std::vector<std::string> names, double limitSeconds)
    : cluster_(cluster),
      names_(std::move(names)),
      arrivals_(cluster.isMaster() ? static_cast<std::size_t>(cluster.size()) : 0),
      requests_(arrivals_.size(), MPI_REQUEST_NULL),
      missing_(std::make_unique<std::atomic<bool>[]>(arrivals_.size() + 1)) {
    watchdog_ = std::make_unique<Watchdog>([this] { return describeWait(); }, limitSeconds, roleOf(cluster));
    cluster.startUpIsOver();
    wakePunctually();
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
    return fmt::format("frame {} waits for {}", frame_.load(), who.empty() ? "reports and pictures" : who);
}

void FrameBarrier::awaitEach() {
    for (std::size_t rank = 1; rank < arrivals_.size(); ++rank) {
        missing_[rank] = true;
    }
    Patience patience;
    for (std::size_t done = 1; done < arrivals_.size();) {
        int which = MPI_UNDEFINED;
        int found = 0;
        MPI_Testany(static_cast<int>(requests_.size()), requests_.data(), &which, &found, MPI_STATUS_IGNORE);
        if (found != 0 && which != MPI_UNDEFINED) {
            missing_[static_cast<std::size_t>(which)] = false;
            ++done;
        } else {
            patience.rest();
        }
    }
}

void FrameBarrier::sendToAll(const void* data, std::size_t bytes, int tag) {
    for (std::size_t rank = 1; rank < requests_.size(); ++rank) {
        MPI_Isend(data, static_cast<int>(bytes), MPI_BYTE, static_cast<int>(rank), tag, cluster_.frames(),
                  &requests_[rank]);
    }
    awaitEach();
}

void FrameBarrier::receiveFromMaster(void* data, std::size_t bytes, int tag) const {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Irecv(data, static_cast<int>(bytes), MPI_BYTE, kMaster, tag, cluster_.frames(), &request);
    Patience patience;
    for (int there = 0;;) {
        MPI_Test(&request, &there, MPI_STATUS_IGNORE);
        if (there != 0) {
            return;
        }
        patience.rest();
    }
}

FrameMessage FrameBarrier::begin(const FrameMessage& fromMaster, std::size_t& bytes) {
    const Watched watched(*watchdog_);
    std::array<std::uint8_t, kOneMessage> packet{};
    constexpr std::size_t kRoom = kOneMessage - sizeof(std::uint32_t);
    files::Bytes message;
    std::uint32_t length = 0;
    if (cluster_.isMaster()) {
        frame_ = fromMaster.frame;
        message = fromMaster.encode();
        length = static_cast<std::uint32_t>(message.size());
        std::memcpy(packet.data(), &length, sizeof length);
        const std::size_t first = std::min(message.size(), kRoom);
        std::copy_n(message.begin(), first, packet.begin() + sizeof length);
        sendToAll(packet.data(), sizeof length + first, kFrameTag);
        if (length > kRoom) {  // a long catch-up
            sendToAll(message.data() + kRoom, length - kRoom, kRestTag);
        }
    } else {
        std::this_thread::sleep_until(std::chrono::steady_clock::time_point(std::chrono::nanoseconds(quietUntil_)));
        receiveFromMaster(packet.data(), packet.size(), kFrameTag);
        std::memcpy(&length, packet.data(), sizeof length);
        message.resize(length);
        std::copy_n(packet.begin() + sizeof length, std::min<std::size_t>(length, kRoom), message.begin());
        if (length > kRoom) {
            receiveFromMaster(message.data() + kRoom, length - kRoom, kRestTag);
        }
    }
    bytes = length;
    return FrameMessage::decode(message);
}

Verdict FrameBarrier::meet(const Arrival& mine, std::int64_t nextFrame) {
    const Watched watched(*watchdog_);
    frame_ = mine.frame;
    Ending ending;
    if (cluster_.isMaster()) {
        arrivals_[kMaster] = mine;
        for (std::size_t rank = 1; rank < arrivals_.size(); ++rank) {
            MPI_Irecv(&arrivals_[rank], kArrivalBytes, MPI_BYTE, static_cast<int>(rank), kArrivalTag,
                      cluster_.arrivals(), &requests_[rank]);
        }
        awaitEach();
        const auto differs = [&](auto hash) {
            return std::any_of(arrivals_.begin(), arrivals_.end(),
                               [&](const Arrival& arrival) { return arrival.*hash != mine.*hash; });
        };
        ending.verdict = differs(&Arrival::stateHash)  ? Verdict::otherSand
                         : differs(&Arrival::viewHash) ? Verdict::otherView
                                                       : Verdict::equal;
        ending.quiet = std::max<std::int64_t>(0, nextFrame - nowNs());
        sendToAll(&ending, sizeof ending, kVerdictTag);
    } else {
        MPI_Send(&mine, kArrivalBytes, MPI_BYTE, kMaster, kArrivalTag, cluster_.arrivals());
        receiveFromMaster(&ending, sizeof ending, kVerdictTag);
        quietUntil_ = nowNs() + ending.quiet;
    }
    watchdog_->startUpIsOver();
    return ending.verdict;
}

}  // namespace lockstep
