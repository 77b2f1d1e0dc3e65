// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <concepts>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/fields.hpp"

namespace web {

/// Returns `text` as JSON.
[[nodiscard]] inline std::string quotedText(std::string_view text) {
    std::string json = "\"";
    for (const char sign : text) {
        if (sign == '"' || sign == '\\') {
            json += '\\';
        }
        json += sign >= 0 && sign < ' ' ? fmt::format("\\u{:04x}", static_cast<int>(sign)) : std::string(1, sign);
    }
    return json + "\"";
}

/// Returns a bool, a finite number, an enum with valuesOf(), a text, a list or a described value (base/fields.hpp) as
/// JSON. A page has no library for that, because it would make replica.wasm larger.
template <class Value>
[[nodiscard]] std::string jsonOf(const Value& value) {
    std::string json;
    const auto add = [&json](const std::string& part) { json += (json.empty() ? "" : ",") + part; };
    if constexpr (base::NamedEnum<Value>) {
        return quotedText(base::nameOf(value));
    } else if constexpr (std::is_arithmetic_v<Value>) {
        return fmt::format("{}", value);
    } else if constexpr (std::convertible_to<Value, std::string_view>) {
        return quotedText(value);
    } else if constexpr (base::Described<const Value>) {
        const auto visit = [&add](std::string_view name, const auto& member) {
            add(quotedText(name) + ":" + jsonOf(member));
        };
        Value::fields(value, visit);
        return "{" + json + "}";
    } else {
        for (const auto& element : value) {
            add(jsonOf(element));
        }
        return "[" + json + "]";
    }
}

}  // namespace web
