// SPDX-License-Identifier: Apache-2.0
// Replaces the C library's fdatasync (LD_PRELOAD) for files named session.journal*. Each call appends a line to the
// file named by SANDWALL_SYNC_LOG: "sync", the number of the call, the size of the file [byte]. The call with the
// number SANDWALL_SYNC_FAILS fails with EIO, as on a broken disk.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

bool isJournal(int descriptor) {
    std::array<char, 64> link{};
    std::array<char, 4096> path{};
    std::snprintf(link.data(), link.size(), "/proc/self/fd/%d", descriptor);
    return readlink(link.data(), path.data(), path.size() - 1) > 0 &&
           std::strstr(path.data(), "/session.journal") != nullptr;
}

void log(int number, int descriptor) {
    struct stat file {};
    const char* const log = std::getenv("SANDWALL_SYNC_LOG");
    if (log == nullptr || fstat(descriptor, &file) != 0) {
        return;
    }
    const int to = open(log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    dprintf(to, "sync %d %lld\n", number, static_cast<long long>(file.st_size));
    close(to);
}

}  // namespace

extern "C" int fdatasync(int descriptor) {
    static std::atomic<int> calls{0};
    static const auto real = reinterpret_cast<int (*)(int)>(dlsym(RTLD_NEXT, "fdatasync"));
    if (!isJournal(descriptor)) {
        return real(descriptor);
    }
    const int number = ++calls;
    log(number, descriptor);
    const char* const fails = std::getenv("SANDWALL_SYNC_FAILS");
    if (fails != nullptr && std::atoi(fails) == number) {
        errno = EIO;
        return -1;
    }
    return real(descriptor);
}
