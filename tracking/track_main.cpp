// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <limits>
#include <thread>

#include "base/input_error.hpp"
#include "host/command_line.hpp"
#include "host/print_line.hpp"
#include "host/version.hpp"
#include "tracking/head_trace.hpp"
#include "tracking/packet_sender.hpp"

namespace {

using namespace tracking;
using Seconds = std::chrono::duration<double>;

struct Options {
    std::string send, listen, trace;
    double rate = 60;
    double seconds = std::numeric_limits<double>::infinity();
};

/// Calls `act` with the time since the first call [s], `rate` times per second, until it returns false or `seconds` are
/// over.
template <class Act>
void atRate(double rate, double seconds, Act act) {
    const auto start = std::chrono::steady_clock::now();
    for (double i = 0; i / rate <= seconds; ++i) {
        std::this_thread::sleep_until(start + std::chrono::duration_cast<std::chrono::nanoseconds>(Seconds(i / rate)));
        if (!act(i / rate)) {
            return;
        }
    }
}

int send(const Options& options) {
    PacketSender sender(Source::parse(options.send, "--send"));
    std::optional<HeadTrace> trace;
    double seconds = options.seconds;
    if (!options.trace.empty()) {
        trace.emplace(HeadTrace::load(options.trace, RoomMapping{}));
        seconds = std::min(seconds, trace->duration());
    }
    atRate(options.rate, seconds, [&](double time) {
        sender.send(trace ? trace->at(time) : sway(time));
        return true;
    });
    host::printLine("{} packets sent", sender.sent());
    return 0;
}

int listen(const Options& options) {
    const Source source = Source::parse(options.listen, "--listen");
    const auto print = [](const std::string& line) { host::printLine("{}", line); };
    const auto tracker = openTracker(source, glm::dvec3(0), print);
    if (!tracker) {
        throw base::InputError("--listen: 'none' is not a tracker; give a source such as opentrack:4242");
    }
    // The output is a trace.
    fmt::print("time,x,y,z,right_x,right_y,right_z\n");
    std::optional<Pose> last;
    atRate(options.rate, options.seconds, [&](double time) {
        const std::optional<Pose> pose = tracker->newest(time);
        if (pose && pose != last) {
            const glm::dvec3 p = pose->position, r = pose->right;
            fmt::print("{:.4f},{:.4f},{:.4f},{:.4f},{:.5f},{:.5f},{:.5f}\n", time, p.x, p.y, p.z, r.x, r.y, r.z);
            last = pose;
        }
        return std::fflush(stdout) == 0;
    });
    const Counters counters = tracker->counters();
    host::printLine("{} packets, {} refused, {} old, {} without the head, {} times lost", counters.packets,
                    counters.refused, counters.old, counters.absent, counters.timesLost);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (host::answersVersion(argc, argv, "sandwall-track")) {
        return 0;
    }
    host::CommandLine line(
        "Tests head tracking without a wall. Sends a head's poses as a tracker would, or prints the poses that arrive.",
        "sandwall-track");
    Options options;
    const host::Option sending =
        line.option("--send", options.send, "opentrack:[HOST:]PORT or dtrack:[HOST:]PORT[:BODY] to send to");
    line.option("--listen", options.listen, "a source as for sandwall run --track (docs/head_tracking.md)")
        .excludes(sending);
    line.option("--trace", options.trace,
                "send the poses of this trace, instead of a head that sways from side to side");
    line.option("--rate", options.rate, "packets to send, or reads of the tracker, per second").range(1.0, 1000.0);
    line.option("--seconds", options.seconds, "end after this time").positive();
    return host::runMain(line, argc, argv, [&] {
        if (!options.trace.empty() && options.send.empty()) {
            throw base::InputError("--trace is for --send");
        }
        if (options.send.empty() && options.listen.empty()) {
            throw base::InputError("give --send or --listen; try --help");
        }
        return options.send.empty() ? listen(options) : send(options);
    });
}
