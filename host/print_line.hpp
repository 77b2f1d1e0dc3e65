// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cerrno>
#include <string>
#include <utility>

#include "host/rank_output.hpp"

namespace host {

/// Prints one line for a person on standard error, with the name of this program in front:
/// `sandwall-relax: warning: dem.asc: ...`. Throws nothing if standard error cannot be written; the line is then lost.
/// Any thread.
template <class... T>
void printLine(fmt::format_string<T...> format, T&&... arguments) {
    // Several programs on several hosts print into one session's log, so each line names its program.
    const std::string line =
        fmt::format("{}: {}\n", program_invocation_short_name, fmt::format(format, std::forward<T>(arguments)...));
    // fmt::print would throw if standard error is a log on a full disk. A lost line must not end a session.
    writeLine(line);
}

}  // namespace host
