// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "base/fields.hpp"

namespace described {

/// Calls `use.template operator()<T>()` for each type of a list.
template <class List, class Use>
void forEachType(const Use& use) {
    [&]<class... T>(std::type_identity<std::tuple<T...>>) {
        (use.template operator()<T>(), ...);
    }(std::type_identity<List>{});
}

/// Reads the fields of a value, and notes the name of the field that is read now.
class NotingReader {
public:
    explicit NotingReader(base::ByteReader& reader) : reader_(reader) {}
    template <class Member>
    void operator()(std::string_view name, Member&& member) {
        name_ = name;
        base::getMember(reader_, member);
    }
    [[nodiscard]] static bool knows(bool known) { return known; }
    [[nodiscard]] std::string_view name() const { return name_; }

private:
    base::ByteReader& reader_;
    std::string_view name_;
};

/// Returns whether the text with which the bytes of a T are refused names what is wrong: the field that cannot be read,
/// the value as a whole, or its end.
template <class T>
bool isNamed(std::span<const std::uint8_t> bytes, std::string_view why) {
    base::ByteReader reader(bytes);
    NotingReader visit(reader);
    T value;
    try {
        T::fields(value, visit);
    } catch (const base::FormatError&) {
        return why.starts_with(std::string(visit.name()) + ": ");
    }
    if constexpr (requires { value.refusal(); }) {
        if (!value.refusal().empty()) {
            return why == value.refusal();
        }
    }
    return why.starts_with("bytes behind its end: ");
}

/// Decodes the bytes as a T. Returns what is wrong with the result, or an empty text. Bytes must be refused by a name,
/// or give a value that is the same after it is encoded and decoded. Sets `accepted` to whether the bytes are a T.
template <class T>
std::string faultOf(std::span<const std::uint8_t> bytes, bool& accepted) {
    accepted = false;
    try {
        const base::Bytes once = base::encoded(base::decoded<T>(bytes));
        accepted = true;
        return base::encoded(base::decoded<T>(once)) == once ? "" : "it differs after it is encoded and decoded";
    } catch (const base::FormatError& error) {
        if (accepted) {
            return std::string("it is refused after it is encoded: ") + error.what();
        }
        return isNamed<T>(bytes, error.what()) ? "" : std::string("no field is named: ") + error.what();
    }
}

}  // namespace described
