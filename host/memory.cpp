// SPDX-License-Identifier: Apache-2.0
#include "host/memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <limits>

#include "host/control_group.hpp"
#include "host/kernel_numbers.hpp"

namespace host {
namespace {

constexpr std::int64_t kUnlimited = std::numeric_limits<std::int64_t>::max();

std::int64_t available() {
    const auto kilobytes = numberOf("MemAvailable:", "/proc/meminfo");
    return kilobytes ? *kilobytes * 1024 : kUnlimited;
}

}  // namespace

std::int64_t freeMemory() {
    // /proc/meminfo does not show the limit of a container.
    return std::min(available(), freeInControlGroups().value_or(kUnlimited));
}

std::int64_t freeMemoryOfProcess() {
    rlimit limit{};
    const auto pages = numberIn("/proc/self/statm");
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || !pages) {
        return freeMemory();
    }
    const auto most = static_cast<std::int64_t>(std::min<rlim_t>(limit.rlim_cur, static_cast<rlim_t>(kUnlimited)));
    return std::min(freeMemory(), std::max<std::int64_t>(most - *pages * sysconf(_SC_PAGESIZE), 0));
}

}  // namespace host
