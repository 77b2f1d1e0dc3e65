// SPDX-License-Identifier: Apache-2.0
#include "host/event.hpp"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "host/rank_output.hpp"

namespace host {
namespace {

using nlohmann::ordered_json;

ordered_json jsonOf(const EventValue& value) {
    return std::visit(
        [](const auto& held) -> ordered_json {
            if constexpr (std::is_same_v<std::decay_t<decltype(held)>, Json>) {
                ordered_json parsed = ordered_json::parse(held.text, nullptr, false);
                if (parsed.is_discarded()) {
                    throw std::invalid_argument("event value is not JSON: " + held.text);
                }
                return parsed;
            } else {
                return held;
            }
        },
        value.get());
}

constexpr const char* kVariable = "SANDWALL_EVENTS";

std::string_view given() {
    const char* const variable = std::getenv(kVariable);
    return variable == nullptr ? "" : variable;
}

bool wanted() {
    static const bool on = given() == "1";
    return on;
}

}  // namespace

std::string whyBadEventsVariable() {
    const std::string_view value = given();
    return value.empty() || value == "0" || value == "1"
               ? ""
               : std::string(kVariable) + ": must be 0 or 1, got '" + std::string(value) + "'";
}

std::string eventLine(std::string_view name, const EventFields& fields) {
    ordered_json json{{"event", name}};
    for (const auto& [key, value] : fields) {
        json[std::string(key)] = jsonOf(value);
    }
    return "@sandwall " + json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

void emitEvent(std::string_view name, const EventFields& fields) {
    if (!wanted()) {
        return;
    }
    writeLine(eventLine(name, fields) + "\n");
}

}  // namespace host
