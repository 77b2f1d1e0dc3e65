// SPDX-License-Identifier: Apache-2.0
// Messages of any length that FrameBarrier passes between ranks, between two frames.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "lockstep/frame_barrier.hpp"

namespace lockstep {
namespace {

enum PassTag : int { kLengthTag = 20, kPieceTag };

}  // namespace

base::Bytes FrameBarrier::pass(int from, const std::vector<int>& to, const base::Bytes& bytes) {
    const Watched watched(*watchdog_);
    base::Bytes got;
    const bool sends = cluster_.rank() == from;
    if (!sends && std::find(to.begin(), to.end(), cluster_.rank()) == to.end()) {
        return got;
    }
    const std::vector<int> peers = sends ? to : std::vector<int>{from};
    std::vector<MPI_Request> requests(peers.size(), MPI_REQUEST_NULL);
    const auto move = [&](std::uint8_t* data, std::uint64_t count, int tag) {
        for (std::size_t i = 0; i < peers.size(); ++i) {
            const auto length = static_cast<int>(count);
            if (sends) {
                MPI_Isend(data, length, MPI_BYTE, peers[i], tag, cluster_.frames(), &requests[i]);
            } else {
                MPI_Irecv(data, length, MPI_BYTE, peers[i], tag, cluster_.frames(), &requests[i]);
            }
        }
        if (sends) {
            ring(peers);
        }
        await(requests, peers, sends ? Backoff() : backoffFor(peers));
    };
    std::uint64_t length = bytes.size();
    move(reinterpret_cast<std::uint8_t*>(&length), sizeof length, kLengthTag);
    if (!sends) {
        got.resize(length);
    }
    // One pointer serves both directions; a rank that sends only reads from it.
    std::uint8_t* const data = sends ? const_cast<std::uint8_t*>(bytes.data()) : got.data();
    for (std::uint64_t done = 0; done < length; done += kMpiPiece) {
        move(data + done, std::min(kMpiPiece, length - done), kPieceTag);
    }
    return got;
}

std::vector<base::Bytes> FrameBarrier::collect(const base::Bytes& mine) {
    if (!cluster_.isMaster()) {
        (void)pass(cluster_.rank(), {kMaster}, mine);
        return {};
    }
    std::vector<base::Bytes> all{mine};
    for (const int rank : ranks_) {
        all.push_back(pass(rank, {kMaster}, {}));
    }
    return all;
}

base::Bytes FrameBarrier::broadcast(const base::Bytes& fromMaster) {
    base::Bytes got = pass(kMaster, cluster_.isMaster() ? ranks_ : std::vector<int>{cluster_.rank()}, fromMaster);
    return cluster_.isMaster() ? fromMaster : got;
}

}  // namespace lockstep
