// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <string_view>

#include "host/command_line.hpp"
#include "host/rank_output.hpp"
#include "host/version.hpp"
#include "host/worker_pool.hpp"
#include "lockstep/cluster.hpp"
#include "render_node/gl_check.hpp"
#include "render_node/tile_session.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

int main(int argc, char** argv) {
    // Options about this program and this host are answered before a job, and need no MPI.
    const bool probes = std::any_of(argv + std::min(argc, 1), argv + argc, [](const std::string_view word) {
        return word == "--probe" || word.starts_with("--probe=");
    });
    if (host::answersVersion(argc, argv, "sandwall-render-node",
                             {{"algorithm", sand::kAlgorithmVersion}, {"state", sand::kStateVersion}})) {
        return 0;
    }
    if (probes) {
        return render_node::probeMain(argc, argv);
    }
    host::CommandLine line(
        "Draws one tile of a wall. mpirun starts it beside sandwall-master, which sends it everything it needs.",
        "sandwall-render-node");
    line.footer("Without mpirun: --probe RANK < WALL checks the backend and the windows of that rank.");
    auto backend = render_node::Backend::automatic;
    line.choice("--gl", backend,
                "backend: osmesa draws in memory, egl on a graphics card without a display, glfw in windows. auto "
                "chooses glfw if the wall file names a display, a monitor or a window's place, else osmesa")
        .offeredBy({"run", "film", "doctor"});
    int sandThreads = 1;
    host::addSandThreads(line, sandThreads).offeredBy({"run", "film"});
    if (line.answersHelp(argc, argv)) {
        return 0;
    }
    lockstep::endWithParent();
    host::sendRankLog();
    lockstep::Cluster cluster(&argc, &argv);
    const int status = host::runMain(line, argc, argv, [&] {
        const host::WorkerPool pool(sandThreads);
        return render_node::showTile(cluster, backend, pool.lend());
    });
    if (status != 0) {
        cluster.abort(status);
    }
    host::removeRankLog();
    return status;
}
