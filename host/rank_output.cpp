// SPDX-License-Identifier: Apache-2.0
#include "host/rank_output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>

#include "base/crc32.hpp"

namespace host {
namespace {

constexpr const char* kAlways = "SANDWALL_RELAY";
constexpr const char* kIfLost = "SANDWALL_RELAY_LOST";

[[nodiscard]] std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

/// Returns the number in a variable of the launcher, or -1 if it is not set.
[[nodiscard]] int numberOfVariable(const char* name) {
    const std::string value = variable(name);
    return value.empty() ? -1 : std::atoi(value.c_str());
}

/// Writes all of `text`. An interrupted write is continued. Returns false if the file is closed or full.
bool writeAll(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t size = write(descriptor, text.data(), text.size());
        if (size > 0) {
            text.remove_prefix(static_cast<std::size_t>(size));
        } else if (size == 0 || errno != EINTR) {
            return false;
        }
    }
    return true;
}

/// Sends a line to the launcher by the descriptor that `variable` names, if it is set.
void relay(const char* variable, std::string_view line) {
    const int descriptor = numberOfVariable(variable);
    const int rank = numberOfVariable("PMIX_RANK");
    if (descriptor >= 0 && rank >= 0) {
        line.remove_suffix(line.ends_with('\n') ? 1 : 0);
        (void)writeAll(descriptor, relayedLine(rank, line) + "\n");
    }
}

}  // namespace

std::string relayedLine(int rank, std::string_view text) {
    const std::string number = std::to_string(rank);
    return fmt::format("@rank {} {} {:08x} {}", number, text.size(), base::crc32(text, base::crc32(number + " ")),
                       text);
}

void writeLine(std::string_view line) {
    std::fflush(stderr);
    const bool written = writeAll(STDERR_FILENO, line);
    relay(kAlways, line);
    if (!written) {
        relay(kIfLost, line);
    }
}

void sendRankLog() {
    if (const std::string path = variable("SANDWALL_RANK_LOG"); !path.empty()) {
        std::array<char, 256> name{};
        gethostname(name.data(), name.size() - 1);
        relay(kAlways, fmt::format("@log {}:{}", name.data(), path));
    }
}

void removeRankLog() {
    if (const std::string path = variable("SANDWALL_RANK_LOG"); !path.empty()) {
        unlink(path.c_str());
    }
}

}  // namespace host
