// SPDX-License-Identifier: Apache-2.0
#include "master/operator/operator_input.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <utility>

#include "master/operator/verb_arguments.hpp"

namespace master {
namespace {

constexpr std::size_t kMostLines = 64;  // between two frames; a person types fewer

volatile std::sig_atomic_t signalled = 0;

void onSignal(int) { signalled = 1; }

}  // namespace

OperatorInput::OperatorInput(bool readInput) {
    struct sigaction action {};
    action.sa_handler = onSignal;
    sigaction(SIGTERM, &action, nullptr);
    sigaction(SIGINT, &action, nullptr);
    // Without this signal, a write to a file at its size limit fails like a write to a full disk.
    action.sa_handler = SIG_IGN;
    sigaction(SIGXFSZ, &action, nullptr);
    if (readInput && pipe(wake_) == 0) {
        thread_ = std::thread([this] { listen(); });
    }
}

OperatorInput::~OperatorInput() {
    if (thread_.joinable()) {
        close(wake_[1]);
        thread_.join();
        close(wake_[0]);
    }
}

bool OperatorInput::stopAsked() const { return stop_ || signalled != 0; }

std::vector<std::string> OperatorInput::takeLines() {
    const std::lock_guard lock(mutex_);
    return std::exchange(lines_, {});
}

bool OperatorInput::keep(std::string line) {
    if (line == "stop") {
        return false;
    }
    const std::lock_guard lock(mutex_);
    if (!line.empty() && lines_.size() < kMostLines) {
        lines_.push_back(std::move(line));
    }
    return true;
}

void OperatorInput::listen() {
    std::string text;
    bool listening = true;
    std::array<char, 256> piece{};
    std::array<pollfd, 2> watched{{{STDIN_FILENO, POLLIN, 0}, {wake_[0], POLLIN, 0}}};
    while (listening) {
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
        text.append(piece.data(), static_cast<std::size_t>(count));
        for (std::size_t end = text.find('\n'); end != std::string::npos && listening; end = text.find('\n')) {
            listening = keep(text.substr(0, end));
            text.erase(0, end + 1);
        }
        text.resize(std::min(text.size(), kLongestCommand));
    }
    stop_ = true;
}

}  // namespace master
