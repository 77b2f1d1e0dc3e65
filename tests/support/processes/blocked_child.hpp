// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "tests/support/processes/in_child.hpp"

namespace support {

/// Makes a pipe with a name, to which no process writes. Opening it for reading waits without end.
inline void makePipe(const std::filesystem::path& path) { ASSERT_EQ(mkfifo(path.c_str(), 0600), 0) << path; }

/// Runs `work` in a child process, which SIGALRM ends if `work` waits without end. The 20 seconds are far more than any
/// of these tests computes. Returns whether `work` ended by itself and without a failure.
template <class Work>
bool endsByItself(const Work& work) {
    return statusOfChild([&] {
               alarm(20);
               work();
           }) == 0;
}

}  // namespace support
