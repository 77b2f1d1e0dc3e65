// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <exception>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>

namespace test {

/// Runs `act` in a child process that may map 2 GiB. Returns "done", the text of the exception that `act` has thrown,
/// or a text about the end of the child.
///
/// Sanitizers map terabytes, so that their builds run `act` without a limit.
inline std::string inTwoGiB(const std::function<void()>& act) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) {
        throw std::runtime_error("cannot make a pipe");
    }
    const pid_t child = fork();
    if (child == 0) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
        constexpr rlim_t kLimit = rlim_t{2} << 30;
        const rlimit limit{kLimit, kLimit};
        setrlimit(RLIMIT_AS, &limit);
#endif
        std::array<char, 1000> text{};
        int length = 0;
        try {
            act();
            length = std::snprintf(text.data(), text.size(), "done");
        } catch (const std::exception& error) {
            length = std::snprintf(text.data(), text.size(), "%s", error.what());
        }
        const ssize_t written = write(ends[1], text.data(), static_cast<std::size_t>(length));
        _exit(written == length ? 0 : 1);  // without the handlers of the test program
    }
    close(ends[1]);
    std::string text;
    std::array<char, 1000> part{};
    for (ssize_t count = 0; (count = read(ends[0], part.data(), part.size())) > 0;) {
        text.append(part.data(), static_cast<std::size_t>(count));
    }
    close(ends[0]);
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child || status != 0) {
        return "the child ended with status " + std::to_string(status) + ": " + text;
    }
    return text;
}

}  // namespace test
