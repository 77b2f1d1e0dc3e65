// SPDX-License-Identifier: Apache-2.0
// Ranks that wait for the master's broadcast. The master tells the progress of its work, and may then hang.
#include <fmt/format.h>

#include <chrono>
#include <string_view>
#include <thread>

#include "lockstep/cluster.hpp"

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
    const auto all = cluster.gather(base::Bytes(sent.size()));
    if (cluster.isMaster()) {
        fmt::print("{} ranks, the last has {} bytes\n", cluster.size(), all.back().size());
    }
    return 0;
}
