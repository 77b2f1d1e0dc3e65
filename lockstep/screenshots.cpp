// SPDX-License-Identifier: Apache-2.0
#include "lockstep/screenshots.hpp"

#include <array>

namespace lockstep {
namespace {

constexpr int kHeaderTag = 3;
constexpr int kPixelTag = 4;

}  // namespace

void sendPicture(const Cluster& cluster, const TilePicture& picture) {
    const std::array<int, 3> header{picture.eye, picture.width, picture.height};
    MPI_Send(header.data(), 3, MPI_INT, kMaster, kHeaderTag, cluster.pictures());
    MPI_Send(picture.pixels.data(), static_cast<int>(picture.pixels.size()), MPI_BYTE, kMaster, kPixelTag,
             cluster.pictures());
}

void receivePictures(FrameBarrier& barrier, const std::vector<int>& eyesByRank,
                     const std::function<void(const TilePicture&)>& take) {
    const MPI_Comm comm = barrier.cluster().pictures();
    for (std::size_t rank = 1; rank < eyesByRank.size(); ++rank) {
        for (int i = 0; i < eyesByRank[rank]; ++i) {
            const Watched watched(barrier.watchdog());
            std::array<int, 3> header{};
            const int from = static_cast<int>(rank);
            barrier.setMissing(from, true);
            MPI_Recv(header.data(), 3, MPI_INT, from, kHeaderTag, comm, MPI_STATUS_IGNORE);
            TilePicture picture{from, header[0], header[1], header[2], {}};
            picture.pixels.resize(std::size_t{3} * static_cast<std::size_t>(picture.width) *
                                  static_cast<std::size_t>(picture.height));
            MPI_Recv(picture.pixels.data(), static_cast<int>(picture.pixels.size()), MPI_BYTE, from, kPixelTag, comm,
                     MPI_STATUS_IGNORE);
            barrier.setMissing(from, false);
            take(picture);
        }
    }
}

}  // namespace lockstep
