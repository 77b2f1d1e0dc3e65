// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace support {

/// Returns true if `event` has every field of `wanted` with the same value. Compares nested objects and arrays in the
/// same way.
inline bool holds(const nlohmann::json& event, const nlohmann::json& wanted) {
    if (!wanted.is_structured()) {
        return event == wanted;
    }
    if (wanted.is_array()) {
        if (!event.is_array() || event.size() != wanted.size()) {
            return false;
        }
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            if (!holds(event[i], wanted[i])) {
                return false;
            }
        }
        return true;
    }
    for (const auto& [key, value] : wanted.items()) {
        if (!event.is_object() || !event.contains(key) || !holds(event[key], value)) {
            return false;
        }
    }
    return true;
}

/// Returns the events of one name in the output of programs, in order (docs/events.md). An empty name selects all
/// events. Leaves out an unfinished last line, because the rest of it may still come.
inline std::vector<nlohmann::json> eventsIn(const std::string& output, std::string_view name = "") {
    constexpr std::string_view kTag = "@sandwall ";
    std::vector<nlohmann::json> events;
    std::istringstream lines(output.substr(0, output.rfind('\n') + 1));
    for (std::string line; std::getline(lines, line);) {
        const auto at = line.find(kTag);
        if (at == std::string::npos) {
            continue;
        }
        nlohmann::json event = nlohmann::json::parse(line.substr(at + kTag.size()), nullptr, false);
        if (event.is_object() && (name.empty() || event.value("event", "") == name)) {
            events.push_back(std::move(event));
        }
    }
    return events;
}

/// Returns the output without its events: the text that a person reads.
///
/// Leaves out a warning of mpirun, which it prints on a loaded machine if a process that it has begun is quick.
inline std::string messagesIn(const std::string& output) {
    std::istringstream lines(output);
    std::string text;
    for (std::string line; std::getline(lines, line);) {
        const bool ofMpirun = line.find("plm:rsh: Warning: setpgid(") != std::string::npos;
        if (!line.starts_with("@sandwall ") && !ofMpirun) {
            text += line + "\n";
        }
    }
    return text;
}

}  // namespace support
