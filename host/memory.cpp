// SPDX-License-Identifier: Apache-2.0
#include "host/memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

namespace host {
namespace {

constexpr std::int64_t kUnlimited = std::numeric_limits<std::int64_t>::max();

/// Returns the number at the start of a file of the kernel, or nullopt if it starts with a word such as "max".
std::optional<std::int64_t> numberIn(const char* file) {
    std::ifstream stream(file);
    std::int64_t number = 0;
    return stream >> number ? std::optional(number) : std::nullopt;
}

/// Returns the number behind a key of a file of the kernel that has a key in each line, or nullopt without the key.
std::optional<std::int64_t> numberOf(const std::string& wanted, const char* file) {
    std::ifstream stream(file);
    std::string key;
    while (stream >> key) {
        std::int64_t number = 0;
        if (key == wanted && stream >> number) {
            return number;
        }
        stream.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    }
    return std::nullopt;
}

std::int64_t available() {
    const auto kilobytes = numberOf("MemAvailable:", "/proc/meminfo");
    return kilobytes ? *kilobytes * 1024 : kUnlimited;
}

}  // namespace

std::int64_t freeMemory() {
    // /proc/meminfo does not show the limit of a container.
    const auto most = numberIn("/sys/fs/cgroup/memory.max");
    const auto used = numberIn("/sys/fs/cgroup/memory.current");
    // The system frees pages of files before it ends a process for lack of memory.
    const std::int64_t files = numberOf("inactive_file", "/sys/fs/cgroup/memory.stat").value_or(0);
    return std::min(available(), most && used ? std::max<std::int64_t>(*most - *used + files, 0) : kUnlimited);
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
