// SPDX-License-Identifier: Apache-2.0
// A libspnav that speaks to the daemon of a test (spacenav_daemon.hpp) at $SPNAV_SOCKET. It waits for the daemon's
// protocol, and cannot tell a daemon that has ended from a silent one, as that of Debian.
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace {

int daemonSocket = -1;
int version = 0;

bool comes(int milliseconds) {
    pollfd wanted{daemonSocket, POLLIN, 0};
    return poll(&wanted, 1, milliseconds) > 0;
}

}  // namespace

extern "C" {
int spnav_close() {
    close(daemonSocket);
    daemonSocket = -1;
    return 0;
}
int spnav_open() {
    const char* path = getenv("SPNAV_SOCKET");
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string_view text = path == nullptr ? "" : path;
    std::copy_n(text.begin(), std::min(text.size(), sizeof address.sun_path - 1), address.sun_path);
    daemonSocket = socket(AF_UNIX, SOCK_STREAM, 0);
    if (connect(daemonSocket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        spnav_close();
        return -1;
    }
    std::uint32_t word = 0x7faa5501;  // "speak version 1"
    (void)!write(daemonSocket, &word, sizeof word);
    version = 0;
    if (comes(300) && read(daemonSocket, &word, sizeof word) == sizeof word) {
        version = static_cast<int>(word & 0xffU);
    }
    return 0;
}
int spnav_fd() { return daemonSocket; }
int spnav_protocol() { return version; }
int spnav_poll_event(void* event) {
    std::array<std::int32_t, 8> packet{};
    if (!comes(0) || read(daemonSocket, packet.data(), sizeof packet) != sizeof packet || packet[0] < 0 ||
        packet[0] > 6) {
        return 0;
    }
    std::array<std::int32_t, 8> words = packet;
    constexpr std::array kTypes{1, 2, 2, 3, 4, 5, 6};  // motion, press, release, device, configuration, raw
    words[0] = kTypes.at(static_cast<std::size_t>(packet[0]));
    if (words[0] == 2) {
        words[1] = packet[0] == 1 ? 1 : 0;
        words[2] = packet[1];
    }
    std::memcpy(event, words.data(), sizeof words);
    return words[0];
}
}
