// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/processes/in_child.hpp"

namespace support {

/// Maps the user and the group into a new user namespace. A process without a mapped id could make no file there.
/// Returns false if the kernel refuses the mapping.
inline bool mapIds(uid_t user, gid_t group) {
    const auto put = [](const char* file, const std::string& text) {
        return static_cast<bool>(std::ofstream(file) << text << std::flush);
    };
    return put("/proc/self/setgroups", "deny") &&
           put("/proc/self/uid_map", std::to_string(user) + " " + std::to_string(user) + " 1") &&
           put("/proc/self/gid_map", std::to_string(group) + " " + std::to_string(group) + " 1");
}

inline constexpr int kNoMount = 77;

/// Runs `work` in a child process, in whose mount namespace a file system of `size` is mounted at `folder`. Returns the
/// child's exit status, or kNoMount if this machine does not allow the mount.
template <class Work>
int onSmallDisk(const std::filesystem::path& folder, const char* size, const Work& work, unsigned long flags = 0) {
    return statusOfChild([&] {
        const uid_t user = getuid();
        const gid_t group = getgid();
        const std::string options = std::string("mode=700,") + size;  // a session refuses a folder of all users
        if (unshare(user == 0 ? CLONE_NEWNS : CLONE_NEWNS | CLONE_NEWUSER) != 0 ||
            (user != 0 && !mapIds(user, group)) || mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
            mount("none", folder.c_str(), "tmpfs", flags, options.c_str()) != 0) {
            _exit(kNoMount);
        }
        work();
    });
}

/// Runs `work` as onSmallDisk() does, and expects that it succeeds. Skips the test if this machine does not allow the
/// mount. Call it as the last statement of a test.
template <class Work>
void testOnSmallDisk(const std::filesystem::path& folder, const char* size, const Work& work, unsigned long flags = 0) {
    const int status = onSmallDisk(folder, size, work, flags);
    if (status == kNoMount) {
        GTEST_SKIP() << "this machine does not allow a file system of a test's own";
    }
    EXPECT_EQ(status, 0);
}

/// Fills the file system with a file of zeros.
inline void fill(const std::filesystem::path& file) {
    const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT, 0644);
    const std::string zeros(4096, '\0');
    while (write(descriptor, zeros.data(), zeros.size()) > 0) {
    }
    close(descriptor);
}

/// Gives the disk at `folder`, on which onSmallDisk() has put this process, another size.
inline void resizeSmallDisk(const std::filesystem::path& folder, const char* size) {
    EXPECT_EQ(mount("none", folder.c_str(), "tmpfs", MS_REMOUNT, size), 0) << std::strerror(errno);
}

}  // namespace support
