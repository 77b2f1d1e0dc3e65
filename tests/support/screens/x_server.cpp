// SPDX-License-Identifier: Apache-2.0
#include "tests/support/screens/x_server.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace support {
namespace {

// The dummy driver shows nothing. Its monitors are switched by RandR, as those of a card.
constexpr const char* kMonitors = R"(
Section "ServerFlags"
  Option "DontVTSwitch" "true"
  Option "AllowMouseOpenFail" "true"
  Option "AutoAddDevices" "false"
  Option "AutoEnableDevices" "false"
EndSection
Section "Device"
  Identifier "card"
  Driver "dummy"
  VideoRam 256000
EndSection
Section "Monitor"
  Identifier "any"
  HorizSync 5.0 - 1000.0
  VertRefresh 5.0 - 200.0
  Modeline "640x360" 17.75 640 656 720 800 360 363 368 374
EndSection
Section "Screen"
  Identifier "all"
  Device "card"
  Monitor "any"
  DefaultDepth 24
  SubSection "Display"
    Depth 24
    Modes "640x360"
    Virtual 2560 1440
  EndSubSection
EndSection
)";

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
    start(command, folder / "xvfb.log");
}

std::unique_ptr<XServer> XServer::withMonitors(const std::filesystem::path& folder) {
    std::ofstream(folder / "xorg.conf") << kMonitors;
    const std::string log = (folder / "xorg.log").string();
    std::unique_ptr<XServer> server(new XServer);
    try {
        server->start({"/usr/bin/env", "Xorg", "-displayfd", "1", "-nolisten", "tcp", "-noreset", "-logfile", log,
                       "-config", (folder / "xorg.conf").string()},
                      folder / "xorg.out");
    } catch (const std::runtime_error&) {
        return nullptr;
    }
    return server;
}

void XServer::start(const std::vector<std::string>& command, const std::filesystem::path& log) {
    process_ = std::make_unique<ChildProcess>(command, log);
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (display_.empty()) {
        const bool ended = process_->wait(0).has_value();
        const std::string number = displayNumber(process_->output());
        if (!number.empty()) {
            display_ = ":" + number;
        } else if (ended || std::chrono::steady_clock::now() > until) {
            throw std::runtime_error(command[0] + " (Debian's package xvfb) did not start: " + process_->output());
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
