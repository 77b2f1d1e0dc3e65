// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include "files/command_line.hpp"
#include "lockstep/cluster.hpp"
#include "render_node/tile_session.hpp"

int main(int argc, char** argv) {
    lockstep::dieWithParent();
    lockstep::Cluster cluster(&argc, &argv);
    CLI::App app("A render rank of a wall: one tile. Started by mpirun beside sandwall-master, which tells it everything.",
                 "sandwall-render-node");
    std::string gl = "auto";
    app.add_option("--gl", gl, "what draws")->check(CLI::IsMember({"auto", "osmesa"}));
    // The one backend there is so far; "auto" will prefer a window where the wall file asks for one.
    const int status = files::runMain(
        app, argc, argv, [&] { return render_node::showTile(cluster, render_node::Backend::osmesa); });
    if (status != 0) {
        cluster.abort(status);
    }
    return status;
}
