// SPDX-License-Identifier: Apache-2.0
// Ranks that wait for the master's broadcast, and then for each other. All tell their progress, and some hang.
#include <fmt/format.h>

#include <chrono>
#include <string_view>
#include <thread>

#include "lockstep/cluster.hpp"

namespace {

/// Makes the part of a session of rank `rank`: the last one takes longer than the limit, or hangs.
void makePart(const lockstep::Cluster& cluster, std::string_view what) {
    constexpr int kParts = 32;
    constexpr std::chrono::milliseconds kPart{250};
    for (int part = 1; what == "slow rank" && cluster.rank() == 2 && part <= kParts; ++part) {
        std::this_thread::sleep_for(kPart);
        cluster.rankProgress(static_cast<double>(part) / kParts);
    }
    if (what == "hanging rank" && cluster.rank() == 2) {
        cluster.rankProgress(0.3);
        std::this_thread::sleep_for(std::chrono::hours(2));
    }
    for (int again = 0; again < 1000; ++again) {
        cluster.rankProgress(1);  // only the first one is sent
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::string_view what = argc > 1 ? argv[1] : "";
    const lockstep::Cluster cluster(&argc, &argv);
    cluster.mayTakeLong(true);
    if (cluster.isMaster()) {
        for (int done = 0; done < 1000; ++done) {  // far more messages than hundredths
            cluster.progress("the made-up work", done * 1e-3);
        }
        if (what == "hangs") {
            std::this_thread::sleep_for(std::chrono::hours(2));
        }
        cluster.progressEnds();
        if (what == "goes back") {
            cluster.progress("the made-up work", 0.5);
            for (int done = 0; done < 1000; ++done) {
                cluster.progress("the made-up work", 0);
            }
        }
    }
    cluster.awaitBroadcast();
    const base::Bytes sent = cluster.broadcast(cluster.isMaster() ? base::Bytes(3, 7) : base::Bytes());
    double made = 0;
    if (!cluster.isMaster()) {
        makePart(cluster, what);
    }
    const auto all = cluster.gatherReady(base::Bytes(sent.size()), [&made](double share) { made = share; });
    const bool agreed = cluster.agree(what != "refused");
    if (cluster.isMaster()) {
        fmt::print("{} ranks, the last has {} bytes; {:.2f} made\n", cluster.size(), all.back().size(), made);
    } else if (agreed == (what == "refused")) {
        return 3;
    }
    return 0;
}
