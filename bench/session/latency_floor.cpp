// SPDX-License-Identifier: Apache-2.0
// Measures a message and a frame without sand, pictures and the wait for a frame. They are the floor of the latency.
#include <fmt/format.h>
#include <mpi.h>
#include <sys/prctl.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <random>
#include <thread>

#include "base/live_histogram.hpp"
#include "haptic_bridge/client/client.hpp"
#include "host/clock.hpp"
#include "host/command_line.hpp"
#include "host/event.hpp"
#include "lockstep/backoff.hpp"

namespace {

using base::LiveHistogram;
using boost::asio::ip::tcp;

constexpr std::chrono::microseconds kFrame{16'667};
constexpr double kMeanPause = 0.005;  // mean pause between echoes [s], in which both ends sleep as in a session

struct Options {
    std::string to;
    int bytes = 74;  // size of the message, or of the frame message
    double seconds = 3;
    std::uint32_t seed = 7;
};

void print(const LiveHistogram& times) {
    fmt::print("{{\"mean_ms\": {}, \"stddev_ms\": {}, \"p50_ms\": {}, \"count\": {}}}\n", times.meanNs() * 1e-6,
               times.stddevNs() * 1e-6, times.percentileNs(0.50) * 1e-6, times.count());
}

/// Sends the bytes of each connection back, one connection after another, until this process is ended.
int echo() {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    boost::asio::io_context io;
    tcp::acceptor acceptor(io, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0));
    fmt::print("listening on 127.0.0.1:{}\n", acceptor.local_endpoint().port());
    std::fflush(stdout);
    host::emitEvent("listening", {{"address", fmt::format("127.0.0.1:{}", acceptor.local_endpoint().port())}});
    for (;;) {
        tcp::socket client = acceptor.accept();
        client.set_option(tcp::no_delay(true));
        std::vector<std::uint8_t> chunk(64 * 1024);
        boost::system::error_code error;
        while (!error) {
            const std::size_t count = client.read_some(boost::asio::buffer(chunk), error);
            if (!error) {
                boost::asio::write(client, boost::asio::buffer(chunk, count), error);
            }
        }
    }
}

/// Measures half of the round trip of messages at random times.
int message(const Options& options) {
    const auto to = haptic_bridge::Address::parse(options.to, "--to");
    boost::asio::io_context io;
    tcp::socket socket(io);
    socket.connect({boost::asio::ip::make_address(to.host), to.port});
    socket.set_option(tcp::no_delay(true));
    std::mt19937 random(options.seed);
    std::exponential_distribution<double> pause(1 / kMeanPause);
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(options.bytes));
    LiveHistogram half;
    for (const std::int64_t end = host::monotonicNs() + static_cast<std::int64_t>(options.seconds * 1e9);
         host::monotonicNs() < end;) {
        std::this_thread::sleep_for(std::chrono::duration<double>(pause(random)));
        const std::int64_t sent = host::monotonicNs();
        boost::asio::write(socket, boost::asio::buffer(bytes));
        boost::asio::read(socket, boost::asio::buffer(bytes));
        half.add((host::monotonicNs() - sent) / 2);
    }
    print(half);
    return 0;
}

/// Waits for `request` as the ranks of a wall do, with sleeps. MPI's own wait never sleeps, so the scheduler would
/// prefer other processes on the ranks' cores.
void await(MPI_Request request) {
    lockstep::Backoff backoff;
    for (int done = 0; MPI_Test(&request, &done, MPI_STATUS_IGNORE), done == 0;) {
        backoff.rest();
    }
}

/// Measures a broadcast and a barrier at rank 0, 60 times per second.
int frame(const Options& options) {
    MPI_Init(nullptr, nullptr);
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    lockstep::wakePunctually();
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(options.bytes), 1);
    LiveHistogram whole;
    std::int64_t end = 0;
    for (int round = 0; bytes[0] != 0; ++round) {
        constexpr int kWarmUp = 10;  // rounds in which connections are made
        // The other ranks come a little earlier, as render ranks do.
        std::this_thread::sleep_for(rank == 0 ? kFrame : kFrame - std::chrono::milliseconds(1));
        const std::int64_t began = host::monotonicNs();
        end = round == kWarmUp ? began + static_cast<std::int64_t>(options.seconds * 1e9) : end;
        bytes[0] = round > kWarmUp && began > end ? 0 : 1;
        MPI_Request request = MPI_REQUEST_NULL;
        MPI_Ibcast(bytes.data(), options.bytes, MPI_BYTE, 0, MPI_COMM_WORLD, &request);
        await(request);
        MPI_Ibarrier(MPI_COMM_WORLD, &request);
        // NOLINTNEXTLINE(clang-analyzer-optin.mpi.MPI-Checker): await() waits for it
        await(request);
        if (round >= kWarmUp) {
            whole.add(host::monotonicNs() - began);
        }
    }
    if (rank == 0) {
        print(whole);
    }
    MPI_Finalize();
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    host::CommandLine line(
        "Measures a bare message over TCP, or a bare broadcast and barrier over MPI. Prints mean and spread as JSON.",
        "sandwall-latency-floor");
    Options options;
    const host::CommandLine echoes = line.command("echo", "answer messages until this program is ended");
    host::CommandLine messages = line.command("message", "measure half of the round trip to an echo, at random times");
    host::CommandLine frames = line.command("frame", "measure a broadcast and a barrier; needs mpirun");
    messages.option("--to", options.to, "ADDRESS:PORT of the echo").required();
    for (host::CommandLine* command : {&messages, &frames}) {
        command->option("--bytes", options.bytes, "size of a message").range(1, 1 << 20);
        command->option("--seconds", options.seconds, "seconds to measure").range(0.1, 600.0);
        command->option("--seed", options.seed, "seed of the random times");
    }
    return host::runMain(line, argc, argv, [&] {
        return echoes.given() ? echo() : messages.given() ? message(options) : frame(options);
    });
}
