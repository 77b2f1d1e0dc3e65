// SPDX-License-Identifier: Apache-2.0
// Sets the clocks of one rank ahead, as on another machine (LD_PRELOAD). SANDWALL_CLOCK_RANK is the rank.
// SANDWALL_CLOCK_AHEAD is the difference of the monotonic clock, and SANDWALL_DATE_AHEAD that of the time of day [s].
#include <dlfcn.h>
#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>

#include "tests/support/machine/preloaded.hpp"

namespace {

/// Returns by how much a clock of this process is ahead, as `variable` says [s].
time_t secondsIn(const char* variable) {
    const char* const seconds = std::getenv(variable);
    return seconds != nullptr && preloaded::isRankOf("SANDWALL_CLOCK_RANK") ? std::atol(seconds) : 0;
}

time_t ahead() {
    static const time_t seconds = secondsIn("SANDWALL_CLOCK_AHEAD");
    return seconds;
}

time_t dateAhead() {
    static const time_t seconds = secondsIn("SANDWALL_DATE_AHEAD");
    return seconds;
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
    const auto result = static_cast<int>(syscall(SYS_clock_gettime, clock, time));
    time->tv_sec += clock == CLOCK_MONOTONIC ? ahead() : clock == CLOCK_REALTIME ? dateAhead() : 0;
    return result;
}

// The kernel has its own clock.
int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* held, clockid_t clock, const timespec* limit) {
    using Function = int (*)(pthread_cond_t*, pthread_mutex_t*, clockid_t, const timespec*);
    static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "pthread_cond_clockwait"));
    timespec kernels = *limit;
    kernels.tv_sec -= clock == CLOCK_MONOTONIC ? ahead() : 0;
    return real(condition, held, clock, &kernels);
}
}
