// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/child_process.hpp"

namespace support {

/// An X server in memory (Xvfb) on a free display. It ends with this object.
class XServer {
public:
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
    std::unique_ptr<ChildProcess> process_;
    std::string display_;
};

}  // namespace support
