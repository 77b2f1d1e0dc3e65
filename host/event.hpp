// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace host {

/// Value in an event: a JSON scalar, or JSON text that is copied as it is (`Json`).
struct Json {
    std::string text;
};
class EventValue {
public:
    EventValue(bool value) : value_(value) {}
    EventValue(double value) : value_(value) {}
    template <std::integral Integer>
    EventValue(Integer value) : value_(static_cast<std::int64_t>(value)) {}
    EventValue(std::string value) : value_(std::move(value)) {}
    EventValue(std::string_view value) : value_(std::string(value)) {}
    EventValue(const char* value) : value_(std::string(value)) {}
    EventValue(Json value) : value_(std::move(value)) {}

    using Value = std::variant<bool, std::int64_t, double, std::string, Json>;
    [[nodiscard]] const Value& get() const { return value_; }

private:
    Value value_;
};
using EventFields = std::vector<std::pair<std::string_view, EventValue>>;

/// Returns the line that emitEvent() writes, without its newline: `@sandwall {"event":"drill","frame":30}`.
///
/// Replaces bytes that are not UTF-8. Throws std::invalid_argument if a Json value is not JSON.
[[nodiscard]] std::string eventLine(std::string_view name, const EventFields& fields);

/// Returns why the value of the environment variable SANDWALL_EVENTS cannot be used: it is not 0, 1 or empty. Returns
/// an empty text if it can.
[[nodiscard]] std::string whyBadEventsVariable();

/// Writes an event to standard error as one line, when the environment variable SANDWALL_EVENTS is 1.
///
/// Messages are for people, and their wording may change. Events are for programs, and keep their names and fields
/// (docs/events.md). Each line is one write(2), so that lines of several threads do not mix. Threads: any.
void emitEvent(std::string_view name, const EventFields& fields = {});

}  // namespace host
