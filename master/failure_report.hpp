// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace master {

/// Why a session has ended itself, for whoever starts it again: OUT/failure.json.
struct FailureReport {
    std::string what;     // "broken", "hung" or "disk"
    int rank = -1;        // 0: the master; -1: nobody in particular
    std::string host;     // that it runs on
    std::string tile;     // empty for the master
    std::string message;  // one line
};

/// Writes it whole or not at all; false, with a line on standard error, when it cannot. Any thread.
bool writeFailure(const FailureReport& failure, const std::filesystem::path& folder);

}  // namespace master
