// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/processes/child_process.hpp"

namespace support {

/// An X server in memory on a free display. It ends with this object.
class XServer {
public:
    /// Starts Xorg with its dummy driver, which has the monitors DUMMY0 (on, 640 x 360 pixels), DUMMY1 (off) and more,
    /// on a screen of up to 2560 x 1440 pixels. Returns null if one of the two is not installed (Debian's
    /// xserver-xorg-core and xserver-xorg-video-dummy).
    static std::unique_ptr<XServer> withMonitors(const std::filesystem::path& folder);
    /// Starts a server with `screens` in Xvfb's notation, such as "640x480x24". Its output goes to a file in `folder`.
    /// Throws std::runtime_error with that output if the server does not start within a minute.
    XServer(const std::filesystem::path& folder, const std::vector<std::string>& screens);

    ~XServer() { end(); }
    XServer(const XServer&) = delete;
    XServer& operator=(const XServer&) = delete;

    [[nodiscard]] const std::string& display() const { return display_; }  // ":3"
    /// Ends the server, which cuts the connections of its clients.
    void end();

private:
    XServer() = default;
    void start(const std::vector<std::string>& command, const std::filesystem::path& log);

    std::unique_ptr<ChildProcess> process_;
    std::string display_;
};

}  // namespace support
