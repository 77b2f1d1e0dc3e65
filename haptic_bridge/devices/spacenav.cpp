// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/spacenav.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "base/input_error.hpp"
#include "haptic_bridge/devices/spnav_library.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {
namespace {

const std::string kUsualLibrary = "libspnav.so.0";
constexpr std::int64_t kPacket = 32;  // [byte], of each packet that the daemon sends

double secondsSince(std::int64_t thenNs) { return static_cast<double>(host::monotonicNs() - thenNs) * 1e-9; }

/// Keeps SIGPIPE from this thread. The library writes to a daemon that may just have ended.
void refusePipeSignal() {
    sigset_t pipe;
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe, nullptr);
}

}  // namespace

SpacenavDevice::SpacenavDevice(const std::string& library)
    : library_(&SpnavLibrary::load(library.empty() ? kUsualLibrary : library,
                                   library.empty() ? "spacenav" : "spacenav:" + library)) {
    const SpnavLibrary::Link link = library_->link();
    if (link == SpnavLibrary::Link::absent) {
        throw base::InputError("--device spacenav: no daemon answers; start spacenavd");
    }
    present_ = linked_ = link == SpnavLibrary::Link::linked;
    heardNs_ = host::monotonicNs();
    thread_ = std::thread([this] { listen(); });
}

SpacenavDevice::~SpacenavDevice() {
    stopping_ = true;
    thread_.join();
    if (linked_) {
        library_->close();
    }
}

void SpacenavDevice::listen() {
    refusePipeSignal();
    while (!stopping_) {
        if (!linked_) {
            tryToLink();
        } else if (takeEvents()) {
            watchSilence();
        } else {  // the daemon has ended
            lose();
            library_->close();
            linked_ = false;
            retry_ = kFirstRetry;
            triedNs_ = 0;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

void SpacenavDevice::tryToLink() {
    if (secondsSince(triedNs_) < retry_) {
        return;
    }
    linked_ = library_->link() == SpnavLibrary::Link::linked;
    triedNs_ = host::monotonicNs();
    retry_ = std::min(2 * retry_, kLastRetry);
    if (linked_) {
        heardNs_ = triedNs_;
        asked_ = false;
        present_ = true;
    }
}

/// Takes all events that have come. Returns whether the daemon still lives.
bool SpacenavDevice::takeEvents() {
    const int socket = library_->socket();
    std::array<char, kPacket> packet{};
    // The library would take half a packet, too.
    while (!stopping_ && recv(socket, packet.data(), packet.size(), MSG_PEEK | MSG_DONTWAIT) == kPacket) {
        heardNs_ = host::monotonicNs();
        asked_ = false;
        takeEvent();
    }
    // For the library, a daemon that has ended is silent.
    pollfd end{.fd = socket, .events = POLLRDHUP, .revents = 0};
    return poll(&end, 1, 0) <= 0;
}

/// Takes a packet. Anything from the daemon shows that it is there, except that the mouse was unplugged.
void SpacenavDevice::takeEvent() {
    SpnavLibrary::Event event{};
    const int type = library_->poll(&event);
    if (type == SpnavLibrary::kDevice && event.plug.unplugged != 0) {
        lose();
        unplugged_ = true;
        return;
    }
    // An answer does not say that a mouse is plugged in again.
    unplugged_ = unplugged_ && type == 0;
    if (type == SpnavLibrary::kMotion) {
        push_[0] = event.motion.x;
        push_[1] = event.motion.y;
        push_[2] = event.motion.z;
    } else if (type == SpnavLibrary::kButton && event.button.bnum == 0) {
        touches_ = event.button.press != 0;
    } else if (type == SpnavLibrary::kButton && event.button.press != 0) {
        ++homings_;
    }
    present_ = !unplugged_;
}

/// Asks a daemon that is silent while the cap is pushed or the button is down. Loses one that hangs.
void SpacenavDevice::watchSilence() {
    const bool pushed = push_[0] != 0 || push_[1] != 0 || push_[2] != 0;
    if (!pushed && !touches_) {
        return;
    }
    const double silence = secondsSince(heardNs_);
    if (!library_->answersQuestions()) {
        // A button that is held at rest sends nothing. It moves no sand.
        if (pushed && silence > kPatienceUnasked) {
            lose();
        }
    } else if (silence > kPatience && asked_) {
        lose();
    } else if (silence > kAskAfter && !asked_) {
        library_->ask();
        asked_ = true;
    }
}

/// The cap and the buttons count as released until the daemon sends something else.
void SpacenavDevice::lose() {
    present_ = false;
    push_[0] = push_[1] = push_[2] = 0;
    touches_ = false;
    ++losses_;
}

Pose SpacenavDevice::read(double time) {
    const double passed = std::clamp(time - time_, 0.0, 0.1);
    time_ = std::max(time_, time);
    const std::uint64_t losses = losses_;
    reading_.present = losses == seenLosses_ && present_;
    seenLosses_ = losses;
    troubles_.answered(reading_.present);
    if (!reading_.present) {
        pose_.engaged = false;
        return pose_;
    }
    const auto speed = [&](std::size_t axis) {
        return std::clamp(push_[axis].load(std::memory_order_relaxed) / kFullDeflection, -1.0, 1.0);
    };
    // Covers any field whose sides have a ratio of up to 1 to 8. The tool cannot touch sand farther out.
    pose_.x = std::clamp(pose_.x + kSpeed * speed(0) * passed, -8.0, 8.0);
    pose_.y = std::clamp(pose_.y + kSpeed * speed(2) * passed, -8.0, 8.0);
    pose_.z = std::clamp(pose_.z + kClimb * speed(1) * passed, -3.0, 20.0);
    if (const int homings = homings_; homings != homed_) {
        homed_ = homings;
        pose_ = {};
    }
    pose_.engaged = touches_;
    return pose_;
}

}  // namespace haptic_bridge
