// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <concepts>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/field_forms.hpp"
#include "base/fields.hpp"
#include "base/input_error.hpp"
#include "host/event.hpp"

/// JSON of described types (base/fields.hpp), in both directions.
///
/// The name of a field is its key, so that the name of a member can change without a change of a file. A name with '/'
/// leads into an object: `visit("views/whole", it.viewsWhole)`.
///
/// | member | JSON |
/// |---|---|
/// | bool, number, text | itself |
/// | enum with valuesOf() | the name of the value |
/// | std::optional | null, or the value |
/// | described type | object |
/// | list, array | array; with base::byName() an object whose keys are the names |
/// | another form of base/field_forms.hpp | as the member that it refers to |
/// | host::ifThere() | the value; without a value the key is left out |
/// | host::Json | the JSON text, without a change |
///
/// A type whose JSON is only written may visit computed values.
namespace host {

/// Largest number that fromJson() takes. A session that counts one thing in each millisecond reaches it in 30 years.
inline constexpr std::uint64_t kMostInJson = 1'000'000'000'000;

/// Form of an optional value whose key is left out if there is no value.
template <class Optional>
struct IfThere {
    Optional& value;
};
template <class Optional>
[[nodiscard]] IfThere<Optional> ifThere(Optional& value) {
    return {value};
}

template <class AnyJson = nlohmann::ordered_json, class Member>
[[nodiscard]] AnyJson jsonOf(const Member& member);

namespace detail {

template <class Member>
inline constexpr bool kIsIfThere = false;
template <class Optional>
inline constexpr bool kIsIfThere<IfThere<Optional>> = true;

}  // namespace detail

/// Adds the fields that it visits to `json`, which is an object or null.
template <class AnyJson>
class JsonWriter {
public:
    explicit JsonWriter(AnyJson& json) : json_(json) {}
    template <class Member>
    void operator()(std::string_view name, const Member& member) {
        if constexpr (detail::kIsIfThere<Member>) {
            if (member.value) {
                (*this)(name, *member.value);
            }
        } else if constexpr (base::Described<Member>) {  // other fields may be in the same object
            AnyJson& inside = at(name);
            inside = inside.is_null() ? AnyJson::object() : inside;
            JsonWriter writer(inside);
            Member::fields(member, writer);
        } else {
            at(name) = jsonOf<AnyJson>(member);
        }
    }

private:
    [[nodiscard]] AnyJson& at(std::string_view name) {
        // Not "/" + std::string(name), about which g++ 12 warns at -O3 in some programs.
        return json_[typename AnyJson::json_pointer(std::string("/").append(name))];
    }

    AnyJson& json_;
};

namespace detail {

template <class Member>
concept Form = requires(const Member& member, base::ByteWriter& writer) {
    member.put(writer);
    member.value;
};
template <class Member>
inline constexpr bool kIsByName = false;
template <class Enum, class Elements>
inline constexpr bool kIsByName<base::ByName<Enum, Elements>> = true;

/// Calls `each` with each element of a base::ByName and its name.
template <class Enum, class Elements, class Each>
void forEachName(const base::ByName<Enum, Elements>& named, const Each& each) {
    for (std::size_t i = 0; i < named.value.size(); ++i) {
        each(std::string(valuesOf(Enum{})[i].name), named.value[i]);
    }
}

}  // namespace detail

/// Returns a value as the table above says.
template <class AnyJson, class Member>
[[nodiscard]] AnyJson jsonOf(const Member& member) {
    if constexpr (std::same_as<Member, Json>) {
        return AnyJson::parse(member.text);
    } else if constexpr (base::detail::kIsOptional<Member>) {
        return member ? jsonOf<AnyJson>(*member) : AnyJson(nullptr);
    } else if constexpr (base::NamedEnum<Member>) {
        return std::string(base::nameOf(member));
    } else if constexpr (base::Described<Member>) {
        AnyJson json = AnyJson::object();
        JsonWriter writer(json);
        Member::fields(member, writer);
        return json;
    } else if constexpr (detail::kIsByName<Member>) {
        AnyJson json = AnyJson::object();
        detail::forEachName(
            member, [&json](const std::string& name, const auto& element) { json[name] = jsonOf<AnyJson>(element); });
        return json;
    } else if constexpr (detail::Form<Member>) {
        return jsonOf<AnyJson>(member.value);
    } else if constexpr (std::ranges::range<Member> && !std::convertible_to<Member, std::string_view>) {
        AnyJson json = AnyJson::array();
        for (const auto& element : member) {
            json.push_back(jsonOf<AnyJson>(element));
        }
        return json;
    } else {
        return AnyJson(member);
    }
}

/// Reads fields from the object `json`. It takes numbers from 0 to kMostInJson.
class JsonReader {
public:
    explicit JsonReader(const nlohmann::ordered_json& json) : json_(json) {}
    template <class Member>
    void operator()(std::string_view name, Member&& member) const {
        std::string path = "/";
        path += name;  // g++ 12 warns of `"/" + std::string(name)`, wrongly
        const nlohmann::ordered_json::json_pointer place(path);
        read(name, json_.contains(place) ? &json_.at(place) : nullptr, member);
    }

private:
    using Value = nlohmann::ordered_json;

    /// `value` is null if the key is missing. `orNull` ends the list of values that are allowed.
    template <class Member>
    static void read(std::string_view name, const Value* value, Member&& member, const char* orNull = "") {
        using T = std::remove_cvref_t<Member>;
        if constexpr (detail::kIsByName<T>) {
            detail::forEachName(member, [&](const std::string& key, auto& element) {
                const bool there = value != nullptr && value->is_object() && value->contains(key);
                read(fmt::format("{}/{}", name, key), there ? &value->at(key) : nullptr, element);
            });
        } else if constexpr (detail::kIsIfThere<T>) {
            member.value.reset();
            if (value != nullptr) {
                read(name, value, member.value.emplace());
            }
        } else if constexpr (base::detail::kIsOptional<T>) {
            member.reset();
            if (value == nullptr || !value->is_null()) {
                read(name, value, member.emplace(), " or null");
            }
        } else {
            const Value given = value == nullptr ? Value() : *value;
            if (!fits<T>(given)) {
                refuse(name, given, allowed<T>() + orNull);
            }
            member = given.get<T>();
        }
    }

    template <class T>
    [[nodiscard]] static bool fits(const Value& value) {
        if constexpr (std::same_as<T, std::string>) {
            return value.is_string();
        } else if constexpr (std::same_as<T, double>) {
            return value.is_number() && value.get<double>() >= 0 && value.get<double>() <= kMostInJson;
        } else {
            static_assert(std::same_as<T, std::uint64_t>);
            return value.is_number_unsigned() && value.get<std::uint64_t>() <= kMostInJson;
        }
    }
    template <class T>
    [[nodiscard]] static std::string allowed() {
        const std::string number = fmt::format("number from 0 to {}", kMostInJson);
        return std::same_as<T, std::string> ? "a text" : (std::same_as<T, double> ? "a " : "a whole ") + number;
    }
    [[noreturn]] static void refuse(std::string_view name, const Value& value, const std::string& allowed) {
        constexpr std::size_t kMostText = 40;  // [byte] of the value, because the file may be damaged
        throw base::InputError(
            fmt::format("{} must be {}, got {}", name, allowed,
                        value.dump(-1, ' ', true, Value::error_handler_t::replace).substr(0, kMostText)));
    }

    const Value& json_;
};

/// Returns the value whose fields are in `json`. Throws base::InputError, which names the first field that is missing
/// or has a value that is not allowed.
template <base::Described T>
[[nodiscard]] T fromJson(const nlohmann::ordered_json& json) {
    T value;
    JsonReader reader(json);
    T::fields(value, reader);
    return value;
}

}  // namespace host
