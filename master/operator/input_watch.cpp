// SPDX-License-Identifier: Apache-2.0
#include "master/operator/input_watch.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "host/print_line.hpp"

namespace master {

InputWatch::InputWatch(int descriptor, std::function<void()> ended)
    : ended_(std::move(ended)), wake_(eventfd(0, EFD_CLOEXEC)) {
    if (wake_ < 0) {
        throw std::system_error(errno, std::generic_category(), "eventfd");
    }
    thread_ = std::thread([this, descriptor] { watch(descriptor); });
}

InputWatch::~InputWatch() {
    (void)eventfd_write(wake_, 1);
    thread_.join();
    close(wake_);
}

void InputWatch::watch(int descriptor) const {
    // Without POLLIN, poll() waits only for the end of the pipe. Linux reports it also while lines are unread.
    std::array<pollfd, 2> watched{{{descriptor, 0, 0}, {wake_, POLLIN, 0}}};
    while (poll(watched.data(), watched.size(), -1) < 0 && errno == EINTR) {
    }
    if (watched[1].revents == 0 && watched[0].revents != 0) {
        ended_();
    }
}

void endForLackOfInput() {
    host::printLine("its input has ended before the first frame; the session is stopped");
    std::fflush(stderr);
    std::_Exit(kExitStopped);
}

}  // namespace master
