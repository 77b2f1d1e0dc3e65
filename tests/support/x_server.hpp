// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/child_process.hpp"

namespace support {

/// An X server in memory (Xvfb) on a display that nobody uses, gone with this.
class XServer {
public:
    /// `screens` as Xvfb takes them: "640x480x24". What it prints goes to a file in `folder`. Throws
    /// std::runtime_error with that when it does not come up within a minute.
    XServer(const std::filesystem::path& folder, const std::vector<std::string>& screens);

    ~XServer() { end(); }
    XServer(const XServer&) = delete;
    XServer& operator=(const XServer&) = delete;

    [[nodiscard]] const std::string& display() const { return display_; }  // ":3"
    /// Ends it; its clients find their connections cut.
    void end();

private:
    std::unique_ptr<ChildProcess> process_;
    std::string display_;
};

}  // namespace support
