// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>

/// Names of the values of an enum, in files, commands and messages.
namespace base {

/// Value of an enum, and its name in files, commands and messages. `constexpr auto valuesOf(Enum)`, beside the enum,
/// returns a std::array of all values.
template <class Enum>
struct Named {
    Enum value;
    std::string_view name;
};

template <class Enum>
Named(Enum, std::string_view) -> Named<Enum>;  // clang 14 does not deduce it

template <class Enum>
concept NamedEnum = std::is_enum_v<Enum> && requires {
    valuesOf(Enum{});
};

/// Returns the names of all values, in the order of valuesOf().
template <NamedEnum Enum>
[[nodiscard]] constexpr auto namesOf() {
    std::array<std::string_view, valuesOf(Enum{}).size()> names;
    for (std::size_t i = 0; i < names.size(); ++i) {
        names[i] = valuesOf(Enum{})[i].name;
    }
    return names;
}

/// Returns the name of a value, or an empty text if valuesOf() does not list it.
template <NamedEnum Enum>
[[nodiscard]] constexpr std::string_view nameOf(Enum value) {
    for (const Named<Enum>& known : valuesOf(Enum{})) {
        if (known.value == value) {
            return known.name;
        }
    }
    return {};
}

/// Returns the value that valuesOf() lists with this name, or nullopt if no value has it.
template <NamedEnum Enum>
[[nodiscard]] constexpr std::optional<Enum> valueNamed(std::string_view name) {
    for (const Named<Enum>& known : valuesOf(Enum{})) {
        if (known.name == name) {
            return known.value;
        }
    }
    return std::nullopt;
}

}  // namespace base
