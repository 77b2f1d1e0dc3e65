// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <string>

namespace haptic_bridge {

/// The parts of libspnav that are used, as its manual describes them. They are declared here, so that a build does not
/// need the library's header.
struct SpnavLibrary {
    enum Type { kMotion = 1, kButton = 2, kDevice = 3 };
    struct Motion {
        int type, x, y, z, rx, ry, rz;
        unsigned int period;
        int* data;
    };
    struct Button {
        int type, press, bnum;
    };
    /// A mouse was plugged in or unplugged.
    struct Plug {
        int type, unplugged, id, kind, usb[2];
    };
    union Event {
        int type;
        Motion motion;
        Button button;
        Plug plug;
    };
    /// Connects this process to the daemon. Returns -1 if it cannot. Since version 1.0 it waits up to kAnswer for the
    /// daemon to name its protocol.
    int (*open)() = nullptr;
    int (*close)() = nullptr;
    /// Takes the next packet of the daemon, without waiting. Returns the type of its event. Returns 0 for another
    /// packet, if none has come, and if the daemon has ended.
    int (*poll)(Event*) = nullptr;
    int (*socket)() = nullptr;
    /// Returns the version of the protocol that the daemon speaks. Null in a library before 1.0, which speaks version
    /// 0.
    int (*protocol)() = nullptr;

    static constexpr double kAnswer = 0.3;  // [s]

    enum class Link : std::uint8_t {
        linked,
        absent,  // no daemon
        early    // an event came first, and open() has taken it for the daemon's answer; try again
    };
    /// Connects to the daemon, and closes a link in which the packets are out of step.
    [[nodiscard]] Link link() const;
    /// Returns whether the daemon answers questions. One of version 0 only sends events.
    [[nodiscard]] bool answersQuestions() const { return protocol != nullptr && protocol() >= 1; }
    /// Asks the daemon for an answer that changes nothing. poll() takes the answer, and returns 0 for it.
    ///
    /// The library's own questions are not used, because they drop the events that come before the answer. One of these
    /// may be the release of the cap.
    void ask() const;

    /// Loads the library once, and never closes it. `name` is a file, or a name that the loader looks for in its own
    /// folders. Throws base::InputError with `option` if it cannot be loaded, or is another library.
    static const SpnavLibrary& load(const std::string& name, const std::string& option);
};

}  // namespace haptic_bridge
