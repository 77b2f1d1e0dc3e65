// SPDX-License-Identifier: Apache-2.0
#include "host/print_line.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

// Standard error of a session may be a log on a full disk. A lost line must not end the program.
TEST(PrintLine, ContinuesIfStandardErrorCannotBeWritten) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        // freopen would give standard error a buffer, and a write into the buffer does not fail.
        if (dup2(open("/dev/full", O_WRONLY | O_CLOEXEC), STDERR_FILENO) < 0) {
            _exit(77);
        }
        host::printLine("a line of {} words", 5);
        _exit(7);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
    EXPECT_EQ(WEXITSTATUS(status), 7);
}

}  // namespace
