// SPDX-License-Identifier: Apache-2.0
#include "tests/support/machine/virtual_time.hpp"

#include <dlfcn.h>
#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <ctime>
#include <mutex>

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;  // [ns]

std::atomic<std::atomic<std::int64_t>*> clockNow{nullptr};  // null: the real clock

std::mutex mutex;  // of the variables below
std::condition_variable changed;
std::int64_t until = 0;   // [ns], a wait may last until then
std::int64_t wanted = 0;  // [ns], the end of the present wait; 0 without one

}  // namespace

namespace support {

VirtualTime::VirtualTime(std::atomic<std::int64_t>& now) {
    const std::lock_guard lock(mutex);
    until = now;
    clockNow = &now;
}

void VirtualTime::pass(double seconds) {
    std::unique_lock lock(mutex);
    until = *clockNow.load() + static_cast<std::int64_t>(seconds * kSecond);
    changed.notify_all();
    changed.wait(lock, [] { return wanted > until; });
}

void VirtualTime::jump(double seconds) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [] { return wanted > 0; });
    *clockNow.load() += static_cast<std::int64_t>(seconds * kSecond);
}

void VirtualTime::end() {
    const std::lock_guard lock(mutex);
    clockNow = nullptr;
    changed.notify_all();
}

}  // namespace support

// The library of C++ reads its steady clock with the first function, and waits for a time of it with the second.
extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
    const std::atomic<std::int64_t>* const now = clockNow;
    if (now == nullptr || clock != CLOCK_MONOTONIC) {
        return static_cast<int>(syscall(SYS_clock_gettime, clock, time));
    }
    time->tv_sec = *now / kSecond;
    time->tv_nsec = *now % kSecond;
    return 0;
}

int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* held, clockid_t clock, const timespec* limit) {
    using Function = int (*)(pthread_cond_t*, pthread_mutex_t*, clockid_t, const timespec*);
    static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "pthread_cond_clockwait"));
    if (clockNow == nullptr || clock != CLOCK_MONOTONIC) {
        return real(condition, held, clock, limit);
    }
    pthread_mutex_unlock(held);
    {
        std::unique_lock lock(mutex);
        wanted = limit->tv_sec * kSecond + limit->tv_nsec;
        changed.notify_all();
        changed.wait(lock, [] { return clockNow == nullptr || wanted <= until; });
        if (std::atomic<std::int64_t>* const now = clockNow) {
            *now = std::max(now->load(), wanted);
        }
        wanted = 0;
    }
    pthread_mutex_lock(held);
    return ETIMEDOUT;
}
}
