// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "base/fields.hpp"
#include "sand/model/step.hpp"

/// Forms of members that only messages of the link have (base/field_forms.hpp).
namespace haptic_bridge {

/// Reads a text of the other side. It is printed on one line, so each control character becomes '?'.
[[nodiscard]] std::string getLine(base::ByteReader& reader);
/// Reads the reason of a Refusal or a Bye, and keeps at most kMaxReason bytes of it. A server that connects again and
/// again must not fill the master's log.
[[nodiscard]] std::string getReason(base::ByteReader& reader);

/// Text for printing. A writer cuts it off after `most` bytes; a reader refuses a longer one.
template <class Text>
struct PrintedText {
    Text& value;
    std::size_t most;
    void put(base::ByteWriter& writer) const { writer.putText(std::string_view(value).substr(0, most)); }
    void get(base::ByteReader& reader) const {
        value = getLine(reader);
        if (value.size() > most) {
            throw base::FormatError("has " + std::to_string(value.size()) + " bytes");
        }
    }
};
template <class Text>
PrintedText(Text&, std::size_t) -> PrintedText<Text>;

/// Reason of a Refusal or a Bye.
template <class Text>
struct Reason {
    Text& value;
    void put(base::ByteWriter& writer) const { writer.putText(value); }
    void get(base::ByteReader& reader) const { value = getReason(reader); }
};
template <class Text>
Reason(Text&) -> Reason<Text>;

/// An edit that must be one: a byte of its kind, its number, which is not 0, and its details.
template <class Edit>
struct WholeEdit {
    Edit& value;
    void put(base::ByteWriter& writer) const {
        writer.put(static_cast<std::uint8_t>(value.kind));
        sand::encodeDetails(value, writer);
    }
    void get(base::ByteReader& reader) const {
        const auto kind = reader.get<std::uint8_t>();
        if (kind == 0 || kind >= sand::kEdits) {
            throw base::FormatError("is " + std::to_string(kind) + ", which is unknown");
        }
        value = sand::decodeDetails(static_cast<sand::Edit::Kind>(kind), reader);
        if (value.number == 0) {
            throw base::FormatError("has number 0, which no edit has");
        }
    }
};
template <class Edit>
WholeEdit(Edit&) -> WholeEdit<Edit>;

}  // namespace haptic_bridge
