// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/parent_watch.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

namespace haptic_bridge {
namespace {

using namespace std::chrono_literals;

constexpr auto kLook = 20ms;  // between two looks at the parent
constexpr std::chrono::milliseconds kStartPatience = 1s;
constexpr auto kLetGo = 100ms;    // the time that the force loop gets to push 0; it needs a tick
std::atomic<bool> killed{false};  // not a member, because the thread below may run until the end of the process
std::atomic<bool> starts{true};

void watch(pid_t parent, std::chrono::milliseconds patience) {
    while (getppid() == parent) {
        std::this_thread::sleep_for(kLook);
    }
    kill(getpid(), SIGTERM);
    std::this_thread::sleep_for(starts ? std::min(kStartPatience, patience) : patience);
    killed = true;
    std::this_thread::sleep_for(kLetGo);
    kill(getpid(), SIGKILL);
}

}  // namespace

void endWithParent(pid_t parent, std::chrono::milliseconds patience) {
    // Continues a stopped process, so that its watch can see what has happened. Also replaces a SIGKILL that the parent
    // has set before exec().
    prctl(PR_SET_PDEATHSIG, SIGCONT);
    // A handler of a signal may hang. It must not run on the thread of the watch.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    std::thread(watch, parent, patience).detach();
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void startIsOver() { starts = false; }

const std::atomic<bool>& aboutToBeKilled() { return killed; }

}  // namespace haptic_bridge
