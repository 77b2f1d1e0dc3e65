// SPDX-License-Identifier: Apache-2.0
// A process of a job notices that another one has ended, although mpirun has not.
#include "lockstep/sibling_watch.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

namespace sibling_watch {
namespace {

constexpr int kMissing = 7, kNothing = 8;  // exit statuses of a process that watches

/// Starts a process as mpirun does, which sleeps.
pid_t startSibling(const char* environment) {
    const pid_t child = fork();
    if (child == 0) {
        const char* const arguments[] = {"sleep", "120", nullptr};
        const char* const variables[] = {environment, nullptr};
        execve("/bin/sleep", const_cast<char* const*>(arguments), const_cast<char* const*>(variables));
        _exit(1);
    }
    return child;
}

/// Starts a process that watches for `longest`, as the process `place` of two on its host. Returns its exit status.
/// This process takes the place of mpirun, and sleeps meanwhile.
int watch(const char* place, std::chrono::milliseconds longest) {
    const pid_t child = fork();
    if (child == 0) {
        setenv("OMPI_COMM_WORLD_LOCAL_SIZE", "2", 1);
        setenv("OMPI_COMM_WORLD_LOCAL_RANK", place, 1);
        {
            const lockstep::SiblingWatch siblings([] { _exit(kMissing); });
            std::this_thread::sleep_for(longest);
        }
        _exit(kNothing);
    }
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void end(pid_t sibling) {
    kill(sibling, SIGKILL);
    EXPECT_EQ(waitpid(sibling, nullptr, 0), sibling);
}

constexpr std::chrono::milliseconds kBriefWatch{3000}, kLongWatch{60'000};

TEST(SiblingWatch, FindsNothingWhileAllProcessesRun) {
    const pid_t sibling = startSibling("OMPI_COMM_WORLD_RANK=1");
    EXPECT_EQ(watch("0", kBriefWatch), kNothing);
    end(sibling);
}

TEST(SiblingWatch, FindsAProcessThatHasEnded) {
    for (const char* place : {"0", "1"}) {
        const pid_t sibling = startSibling("OMPI_COMM_WORLD_RANK=1");
        kill(sibling, SIGTERM);  // stays a zombie, because this process does not wait for it
        EXPECT_EQ(watch(place, kLongWatch), kMissing) << place;
        end(sibling);
        EXPECT_EQ(watch(place, kLongWatch), kMissing) << "also if it left no trace";
    }
}

TEST(SiblingWatch, CountsOnlyProcessesOfTheJob) {
    const pid_t other = startSibling("A=B");
    EXPECT_EQ(watch("0", kLongWatch), kMissing);
    end(other);
}

TEST(SiblingWatch, WatchesOnlyInTheFirstTwoProcessesOfAHost) { EXPECT_EQ(watch("2", kBriefWatch), kNothing); }

}  // namespace
}  // namespace sibling_watch
