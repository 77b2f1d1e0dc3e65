// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "base/input_error.hpp"

namespace master {

/// Largest count in a file of a session. A session that counts one thing in each millisecond reaches it in 30 years.
inline constexpr std::uint64_t kMostCount = 1'000'000'000'000;

[[nodiscard]] inline bool isCount(const nlohmann::ordered_json& value) {
    return value.is_number_unsigned() && value.get<std::uint64_t>() <= kMostCount;
}

/// Throws base::InputError, which names the key `where` and the value: it must be `allowed`.
[[noreturn]] inline void refuseValue(const std::string& where, const nlohmann::ordered_json& value,
                                     const std::string& allowed) {
    constexpr std::size_t kMostText = 40;  // [byte] of the value, because the file may be damaged
    throw base::InputError(
        fmt::format("{} must be {}, got {}", where, allowed,
                    value.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace).substr(0, kMostText)));
}

/// Returns the count at `where` in `json`. A missing one counts as null. Throws as refuseValue() does.
[[nodiscard]] inline std::uint64_t countAt(const nlohmann::ordered_json& json,
                                           const nlohmann::ordered_json::json_pointer& where) {
    const nlohmann::ordered_json value = json.contains(where) ? json.at(where) : nlohmann::ordered_json();
    if (!isCount(value)) {
        refuseValue(where.to_string().substr(1), value, fmt::format("a whole number from 0 to {}", kMostCount));
    }
    return value.get<std::uint64_t>();
}

}  // namespace master
