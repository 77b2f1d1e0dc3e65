// SPDX-License-Identifier: Apache-2.0
#include "master/stop_request.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string>

namespace master {
namespace {

volatile std::sig_atomic_t signalled = 0;

void onSignal(int) { signalled = 1; }

}  // namespace

StopRequest::StopRequest(bool readInput) {
    struct sigaction action {};
    action.sa_handler = onSignal;
    sigaction(SIGTERM, &action, nullptr);
    sigaction(SIGINT, &action, nullptr);
    if (readInput && pipe(wake_) == 0) {
        thread_ = std::thread([this] { listen(); });
    }
}

StopRequest::~StopRequest() {
    if (thread_.joinable()) {
        close(wake_[1]);
        thread_.join();
        close(wake_[0]);
    }
}

bool StopRequest::made() const { return made_ || signalled != 0; }

void StopRequest::listen() {
    std::string line;
    std::array<char, 256> piece{};
    std::array<pollfd, 2> watched{{{STDIN_FILENO, POLLIN, 0}, {wake_[0], POLLIN, 0}}};
    for (;;) {
        if (poll(watched.data(), watched.size(), -1) < 0) {
            if (errno == EINTR) {
                continue;
            }
            break;
        }
        if (watched[1].revents != 0) {
            return;
        }
        if (watched[0].revents == 0) {
            continue;
        }
        const ssize_t count = read(STDIN_FILENO, piece.data(), piece.size());
        if (count <= 0) {
            break;
        }
        line.append(piece.data(), static_cast<std::size_t>(count));
        if (line.find("stop\n") != std::string::npos) {
            break;
        }
        line.erase(0, line.rfind('\n') + 1);
    }
    made_ = true;
}

}  // namespace master
