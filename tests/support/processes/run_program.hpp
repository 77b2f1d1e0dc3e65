// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace support {

struct Ran {
    int status = -1;     // exit status, or -1 if a signal ended the program
    std::string output;  // stdout and stderr together
};

/// Runs a shell command to its end, without events in the output.
inline Ran runCommand(const std::string& command) {
    std::FILE* pipe = popen(("unset SANDWALL_EVENTS; " + command + " 2>&1").c_str(), "r");
    if (pipe == nullptr) {
        throw std::runtime_error("cannot start " + command);
    }
    Ran ran;
    std::array<char, 4096> buffer{};
    for (std::size_t count = 0; (count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
        ran.output.append(buffer.data(), count);
    }
    const int ended = pclose(pipe);
    ran.status = WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
    return ran;
}

/// Returns the path of a program of this build.
inline std::string pathOfProgram(const std::string& name) { return SANDWALL_BIN_DIR "/" + name; }

/// Makes a link to a file of this build in `folder`, and returns its path. LD_PRELOAD takes no path with a blank, and
/// the build's own path may have one.
inline std::string linkTo(const std::string& name, const std::filesystem::path& folder) {
    const std::filesystem::path link = folder / name;
    std::filesystem::remove(link);
    std::filesystem::create_symlink(std::filesystem::absolute(pathOfProgram(name)), link);
    return link.string();
}

/// Returns the path of the script that starts sessions.
inline std::string launcher() { return SANDWALL_SOURCE_DIR "/scripts/sandwall"; }

/// Runs one of our programs to its end. `arguments` are shell words.
inline Ran runProgram(const std::string& name, const std::string& arguments) {
    return runCommand("'" + pathOfProgram(name) + "' " + arguments);
}

}  // namespace support
