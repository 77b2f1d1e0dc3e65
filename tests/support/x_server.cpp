// SPDX-License-Identifier: Apache-2.0
#include "tests/support/x_server.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace support {
namespace {

/// Returns the display number, which Xvfb prints on a line of its own when it accepts connections. Warnings may be
/// printed around it.
std::string displayNumber(const std::string& output) {
    std::istringstream lines(output.substr(0, output.rfind('\n') + 1));
    for (std::string line; std::getline(lines, line);) {
        if (!line.empty() && std::all_of(line.begin(), line.end(), [](char c) { return c >= '0' && c <= '9'; })) {
            return line;
        }
    }
    return "";
}

}  // namespace

XServer::XServer(const std::filesystem::path& folder, const std::vector<std::string>& screens) {
    std::vector<std::string> command{"/usr/bin/Xvfb", "-displayfd", "1", "-nolisten", "tcp", "-noreset"};
    for (std::size_t i = 0; i < screens.size(); ++i) {
        command.insert(command.end(), {"-screen", std::to_string(i), screens[i]});
    }
    process_ = std::make_unique<ChildProcess>(command, folder / "xvfb.log");
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (display_.empty()) {
        const bool ended = process_->wait(0).has_value();
        const std::string number = displayNumber(process_->output());
        if (!number.empty()) {
            display_ = ":" + number;
        } else if (ended || std::chrono::steady_clock::now() > until) {
            throw std::runtime_error("Xvfb (Debian's package xvfb) did not start: " + process_->output());
        } else {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
    }
}

void XServer::end() {
    // SIGKILL would leave the lock file behind, and no other server could use the display number.
    // An Xvfb that had just started on a busy machine once ignored the signal, and ended at the second one.
    constexpr int kTries = 30;
    for (int tries = 0; process_ && tries < kTries && !process_->wait(tries == 0 ? 0 : 1); ++tries) {
        process_->signal(SIGTERM);
    }
}

}  // namespace support
