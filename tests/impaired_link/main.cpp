// SPDX-License-Identifier: Apache-2.0
// The impaired link as a program, for sessions started by hand or by a benchmark.
#include <fmt/format.h>
#include <sys/prctl.h>

#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <cstdio>
#include <optional>

#include "base/input_error.hpp"
#include "haptic_bridge/client/client.hpp"
#include "host/command_line.hpp"
#include "host/event.hpp"
#include "tests/impaired_link/impaired_link.hpp"

namespace {

struct Options {
    std::string to;
    std::uint16_t port = 0;
    bool endWithParent = false;
    impaired_link::Impairment link;
};

void addOptions(host::CommandLine& line, Options& options) {
    impaired_link::Impairment& link = options.link;
    constexpr double kMost = 60'000.0;
    line.option("--to", options.to, "HOST:PORT to which connections are forwarded").required();
    line.option("--port", options.port, "port on 127.0.0.1; 0, the default, selects a free one");
    line.option("--delay", link.delayMs, "least delay [ms]").range(0.0, kMost);
    line.option("--jitter", link.jitterMs, "largest additional delay [ms], evenly spread").range(0.0, kMost);
    line.option("--loss", link.stallShare, "share of pieces that are lost once").range(0.0, 1.0);
    line.option("--stall", link.stallMs, "time until a lost piece is sent again [ms]").range(0.0, kMost);
    line.option("--reset-after", link.resetAfter, "number of bytes after which a connection is reset; 0: never");
    line.option("--resets", link.resets, "largest number of connections to reset").showDefault();
    line.option("--seed", link.seed, "seed of the random numbers").showDefault();
    line.flag("--die-with-parent", options.endWithParent, "end when the program that started this one ends");
}

int run(const Options& options) {
    if (options.endWithParent) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
    }
    const auto to = haptic_bridge::Address::parse(options.to, "--to");
    boost::asio::io_context io;
    boost::asio::signal_set signals(io, SIGINT, SIGTERM);
    signals.async_wait([](boost::system::error_code, int) {});
    std::optional<impaired_link::ImpairedLink> link;
    try {
        link.emplace(options.link, to.host, to.port, options.port);
    } catch (const boost::system::system_error& error) {
        throw base::InputError(fmt::format("--port {}: {}", options.port, error.code().message()));
    }
    fmt::print("listening on 127.0.0.1:{}\n", link->port());
    std::fflush(stdout);
    host::emitEvent("listening", {{"address", fmt::format("127.0.0.1:{}", link->port())}});
    io.run();
    fmt::print("{} connections, {} stalls, {} resets\n", link->connections(), link->stalls(), link->resets());
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    host::CommandLine line("Forwards TCP connections with delay, jitter, stalls and resets, as a bad network would.",
                           "sandwall-impaired-link");
    Options options;
    addOptions(line, options);
    return host::runMain(line, argc, argv, [&] { return run(options); });
}
