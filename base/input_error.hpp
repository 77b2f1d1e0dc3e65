// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>

namespace base {

/// Exit status of every program for input it cannot use; 1 is a failure while running, 0 success.
inline constexpr int kExitBadInput = 2;

/// Something the user gave cannot be used: a file, an option, an address.
///
/// what() is the one line a person reads, such as "walls/lab.toml:12: eye_separation must be positive, got -0.06".
/// Caught once, in each program's main, which prints it behind the program's name and exits with kExitBadInput.
class InputError : public std::runtime_error {
public:
    explicit InputError(const std::string& line) : std::runtime_error(oneLine(line)) {}
    InputError(const std::string& file, long lineNumber, const std::string& message)
        : InputError(file + ":" + std::to_string(lineNumber) + ": " + message) {}

private:
    /// What is quoted from the user may hold line feeds and worse.
    static std::string oneLine(std::string text) {
        std::replace_if(
            text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
        return text;
    }
};

}  // namespace base
