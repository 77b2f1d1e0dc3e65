// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <utility>

namespace host {

/// Prints one line for a person on standard error, with the name of this program in front:
/// `sandwall-relax: warning: dem.asc: ...`. Any thread.
template <class... T>
void printLine(fmt::format_string<T...> format, T&&... arguments) {
    // Several programs on several hosts print into one session's log, so each line names its program.
    fmt::print(stderr, "{}: {}\n", program_invocation_short_name, fmt::format(format, std::forward<T>(arguments)...));
}

}  // namespace host
