// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace support {

/// Sends a line to the control socket of the session in `folder` and returns the answer. `sandwall ctl` does the same,
/// but it would start Python for each command. Returns a discarded value if no session listens or the answer is not
/// JSON.
inline nlohmann::json askSession(const std::filesystem::path& folder, const std::string& line) {
    const std::string path = (folder / "control").string();
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::string answer;
    if (path.size() < sizeof address.sun_path) {
        path.copy(address.sun_path, sizeof address.sun_path - 1);
        const int peer = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        const std::string text = line + "\n";
        if (connect(peer, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
            send(peer, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size())) {
            std::array<char, 4096> piece{};
            for (ssize_t count = 0; (count = recv(peer, piece.data(), piece.size(), 0)) > 0;) {
                answer.append(piece.data(), static_cast<std::size_t>(count));
            }
        }
        close(peer);
    }
    return nlohmann::json::parse(answer, nullptr, false);
}

}  // namespace support
