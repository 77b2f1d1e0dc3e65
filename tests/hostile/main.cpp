// SPDX-License-Identifier: Apache-2.0
// A hostile end of the haptic link, as a program (scripts/checks/hostile.sh).
#include <fmt/format.h>
#include <sys/prctl.h>

#include <chrono>
#include <csignal>
#include <cstdio>

#include "haptic_bridge/client/client.hpp"
#include "haptic_bridge/link/link_options.hpp"
#include "host/command_line.hpp"
#include "host/event.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/hostile/attack.hpp"

int main(int argc, char** argv) {
    host::CommandLine line("Sends bad messages to a haptic server, or to a master that connects.", "sandwall-hostile");
    std::string scene;
    std::uint16_t server = 0;
    std::uint64_t frames = 1'000'000;
    std::uint32_t seed = 1;
    haptic_bridge::LinkOptions link;
    line.option("--scene", scene, "scene file that a correct greeting names").required();
    line.option("--server", server, "port of a server on this machine; without it, this program is a server");
    line.option("--frames", frames, "number of frames to send");
    line.option("--seed", seed, "seed of the random frames");
    link.addTo(line, false);
    return host::runMain(line, argc, argv, [&] {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        const scene::Scene known = scene::loadScene(scene);
        const haptic_bridge::Identity identity{haptic_bridge::kProtocolVersion, sand::kAlgorithmVersion,
                                               known.rules.digest(), known.name};
        if (server != 0) {
            hostile::Frames made(seed, identity);
            const hostile::Done done = hostile::attackServer(
                server, made, frames, [] { return true; }, link.forClient(haptic_bridge::Role::watch));
            fmt::print("seed {}: {} frames over {} connections: {} read, {} refused unread; {} refusals heard\n", seed,
                       done.frames, done.connections, done.read, done.frames - done.read, done.refusals);
            return 0;
        }
        hostile::FalseServer falseServer(seed, identity, frames, link.forServer());
        fmt::print("listening on 127.0.0.1:{}\n", falseServer.port());
        std::fflush(stdout);
        host::emitEvent("listening", {{"address", fmt::format("127.0.0.1:{}", falseServer.port())}});
        while (!falseServer.done()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        fmt::print("seed {}: {} frames and {} positions over {} connections\n", seed, falseServer.frames(),
                   falseServer.positions(), falseServer.connections());
        return 0;
    });
}
