// SPDX-License-Identifier: Apache-2.0
#include "master/operator_input.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <string>

namespace master {
namespace {

constexpr std::size_t kLongestLine = 1024;  // what never ends is no command

volatile std::sig_atomic_t signalled = 0;

void onSignal(int) { signalled = 1; }

}  // namespace

OperatorInput::OperatorInput(bool readInput) {
    struct sigaction action {};
    action.sa_handler = onSignal;
    sigaction(SIGTERM, &action, nullptr);
    sigaction(SIGINT, &action, nullptr);
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

std::optional<lockstep::Pattern> OperatorInput::takePattern(lockstep::Pattern shown) {
    const int asked = pattern_.exchange(kNothing);
    if (asked == kNothing) {
        return std::nullopt;
    }
    return asked == kNext ? lockstep::nextPattern(shown) : static_cast<lockstep::Pattern>(asked);
}

bool OperatorInput::obey(std::string_view line) {
    if (line == "stop") {
        return false;
    }
    constexpr std::string_view kPattern = "pattern ";
    if (line == "settle") {
        edit_ = sand::Edit::settle;
    } else if (line == "pattern next") {
        pattern_ = kNext;
    } else if (line.starts_with(kPattern)) {
        try {
            pattern_ = static_cast<int>(lockstep::parsePattern(line.substr(kPattern.size())));
        } catch (const files::InputError& error) {
            fmt::print(stderr, "{}, next\n", error.what());
        }
    } else if (!line.empty()) {
        fmt::print(stderr, "'{}' is no command; these are: settle, pattern NAME, stop\n", line.substr(0, 80));
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
            listening = obey(std::string_view(text).substr(0, end));
            text.erase(0, end + 1);
        }
        text.resize(std::min(text.size(), kLongestLine));
    }
    stop_ = true;
}

}  // namespace master
