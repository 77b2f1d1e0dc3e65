// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>

namespace base {

/// Exit status of every program for input that it cannot use. Status 1 is a failure while running, 0 is success.
inline constexpr int kExitBadInput = 2;

/// Error in something that the user gave: a file, an option, an address.
///
/// what() is one line for the user, such as "walls/lab.toml:12: eye_separation must be positive, got -0.06".
/// Each program's main catches it, prints it after the program's name, and exits with kExitBadInput.
class InputError : public std::runtime_error {
public:
    explicit InputError(const std::string& line) : std::runtime_error(oneLine(line)) {}
    InputError(const std::string& file, long lineNumber, const std::string& message)
        : InputError(file + ":" + std::to_string(lineNumber) + ": " + message) {}

    /// Replaces control characters, because text that is quoted from the user or a library may contain line feeds.
    static std::string oneLine(std::string text) {
        std::replace_if(
            text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
        return text;
    }
};

}  // namespace base
