// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

#include "base/byte_stream.hpp"
#include "base/names.hpp"

/// Describes a value once, for writing and for reading.
///
/// A described type lists its members in the order of their bytes:
///
///     struct ForceShare {
///         double share = 1;
///         bool byOperator = false;
///         template <class Self, class Visit>
///         static void fields(Self& it, Visit& visit) {
///             visit("share", base::limited(it.share, 0, 1));
///             visit("by_operator", it.byOperator);
///         }
///     };
///
/// encoded() and decoded() follow that list. A member is written as the table says, or in a form of field_forms.hpp. A
/// form refers to a member, and has put(ByteWriter&) and get(ByteReader&).
///
/// | member | bytes |
/// |---|---|
/// | integer, float | fixed size, little-endian; a float must be finite |
/// | bool | one byte, 0 or 1 |
/// | enum with valuesOf() | one byte, one of these values |
/// | std::array of bytes, std::array of other members | the bytes; the elements |
/// | vector of GLM, std::pair | the coordinates; both members |
/// | std::optional | one byte, 0 or 1, and the value after a 1 |
/// | described type | its members |
///
/// A type whose members depend on each other has `std::string refusal() const`, which returns what is wrong, or an
/// empty text. A reader calls it after the last member.
namespace base {

/// Writes the fields of a described type.
class FieldWriter {
public:
    explicit FieldWriter(ByteWriter& writer) : writer_(writer) {}
    template <class Member>
    void operator()(std::string_view name, const Member& member);
    /// Returns true: a writer always writes the fields that follow.
    [[nodiscard]] static bool knows(bool /*known*/) { return true; }

private:
    ByteWriter& writer_;
};

/// Reads the fields of a described type.
class FieldReader {
public:
    explicit FieldReader(ByteReader& reader) : reader_(reader) {}
    template <class Member>
    void operator()(std::string_view name, Member&& member);
    /// Returns `known`. If it is false, the layout of the fields that follow is unknown, and the reader skips to the
    /// end of the bytes.
    [[nodiscard]] bool knows(bool known) {
        if (!known) {
            reader_.getBytes(reader_.rest().size());
        }
        return known;
    }
    /// Returns the name of the field that is read now.
    [[nodiscard]] std::string_view name() const { return name_; }

private:
    ByteReader& reader_;
    std::string_view name_;
};

template <class T>
concept Described = requires(T& value, FieldReader& visit) {
    T::fields(value, visit);
};

namespace detail {

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;
template <class T>
concept Array = requires {
    std::tuple_size<T>::value;
    typename T::value_type;
};
template <class T>
concept ByteArray = Array<T> && std::same_as<typename T::value_type, std::uint8_t>;
/// A vector of GLM, whose headers this file does not need.
template <class T>
concept Vector = requires(T& vector) {
    typename std::integral_constant<int, T::length()>;
    vector[0] = typename T::value_type{};
};
template <class T>
inline constexpr bool kIsPair = false;
template <class A, class B>
inline constexpr bool kIsPair<std::pair<A, B>> = true;

/// Reads one byte that must be 0 or 1.
[[nodiscard]] inline bool getBool(ByteReader& reader) {
    const auto byte = reader.get<std::uint8_t>();
    if (byte > 1) {
        throw FormatError("is " + std::to_string(byte) + ", neither 0 nor 1");
    }
    return byte == 1;
}

}  // namespace detail

/// Writes `member` as the table above says.
template <class Member>
void putMember(ByteWriter& writer, const Member& member) {
    if constexpr (requires { member.put(writer); }) {
        member.put(writer);
    } else if constexpr (std::same_as<Member, bool> || NamedEnum<Member>) {
        writer.put(static_cast<std::uint8_t>(member));
    } else if constexpr (std::is_arithmetic_v<Member>) {
        writer.put(member);
    } else if constexpr (detail::ByteArray<Member>) {
        writer.putBytes(member);
    } else if constexpr (detail::Array<Member>) {
        for (const auto& element : member) {
            putMember(writer, element);
        }
    } else if constexpr (detail::Vector<Member>) {
        for (int i = 0; i < Member::length(); ++i) {
            putMember(writer, member[i]);
        }
    } else if constexpr (detail::kIsPair<Member>) {
        putMember(writer, member.first);
        putMember(writer, member.second);
    } else if constexpr (detail::kIsOptional<Member>) {
        writer.put(static_cast<std::uint8_t>(member.has_value()));
        if (member) {
            putMember(writer, *member);
        }
    } else {
        static_assert(Described<Member>);
        FieldWriter visit(writer);
        Member::fields(member, visit);
    }
}

/// Reads `member` as the table above says. Throws FormatError, which names the field, if its bytes are cut short or
/// hold a value that is not allowed.
template <class Member>
void getMember(ByteReader& reader, Member&& member) {
    using T = std::remove_cvref_t<Member>;
    if constexpr (requires { member.get(reader); }) {
        member.get(reader);
    } else if constexpr (std::same_as<T, bool>) {
        member = detail::getBool(reader);
    } else if constexpr (NamedEnum<T>) {
        const auto byte = reader.get<std::uint8_t>();
        member = static_cast<T>(byte);
        if (nameOf(member).empty()) {
            throw FormatError("is " + std::to_string(byte) + ", which is unknown");
        }
    } else if constexpr (std::is_arithmetic_v<T>) {
        member = reader.get<T>();
        if constexpr (std::is_floating_point_v<T>) {
            if (!std::isfinite(member)) {
                throw FormatError("is not finite");
            }
        }
    } else if constexpr (detail::ByteArray<T>) {
        const auto bytes = reader.getBytes(member.size());
        std::copy(bytes.begin(), bytes.end(), member.begin());
    } else if constexpr (detail::Array<T>) {
        for (auto& element : member) {
            getMember(reader, element);
        }
    } else if constexpr (detail::Vector<T>) {
        for (int i = 0; i < T::length(); ++i) {
            getMember(reader, member[i]);
        }
    } else if constexpr (detail::kIsPair<T>) {
        getMember(reader, member.first);
        getMember(reader, member.second);
    } else if constexpr (detail::kIsOptional<T>) {
        member.reset();
        if (detail::getBool(reader)) {
            getMember(reader, member.emplace());
        }
    } else {
        static_assert(Described<T>);
        FieldReader visit(reader);
        try {
            T::fields(member, visit);
        } catch (const FormatError& error) {
            throw FormatError(std::string(visit.name()) + ": " + error.what());
        }
        if constexpr (requires { member.refusal(); }) {
            if (const std::string refusal = member.refusal(); !refusal.empty()) {
                throw FormatError(refusal);
            }
        }
    }
}

template <class Member>
void FieldWriter::operator()(std::string_view /*name*/, const Member& member) {
    putMember(writer_, member);
}

template <class Member>
void FieldReader::operator()(std::string_view name, Member&& member) {
    name_ = name;
    getMember(reader_, member);
}

/// Returns a described value, or one with get(ByteReader&). More bytes may follow it.
template <class T>
[[nodiscard]] T read(ByteReader& reader) {
    T value;
    getMember(reader, value);
    return value;
}

/// Returns the bytes of a described value.
template <Described T>
[[nodiscard]] Bytes encoded(const T& value) {
    ByteWriter writer;
    putMember(writer, value);
    return writer.take();
}

/// Throws FormatError if bytes are left in `reader`.
inline void requireEnd(const ByteReader& reader) {
    if (!reader.atEnd()) {
        throw FormatError("bytes behind its end: " + std::to_string(reader.rest().size()));
    }
}

/// Returns the value whose bytes are all of `bytes`. Throws FormatError as getMember() does, and if bytes are left.
template <Described T>
[[nodiscard]] T decoded(std::span<const std::uint8_t> bytes) {
    ByteReader reader(bytes);
    T value = read<T>(reader);
    requireEnd(reader);
    return value;
}

/// Returns alternative `index` of a variant of described types, whose bytes are all that are left in `reader`. Throws
/// FormatError, which begins with its name in `names`, if they are not. Requires that `index` is an alternative.
template <class Variant, std::size_t kIndex = 0>
[[nodiscard]] Variant readAlternative(std::size_t index, ByteReader& reader, std::span<const std::string_view> names) {
    if constexpr (kIndex + 1 < std::variant_size_v<Variant>) {
        if (index != kIndex) {
            return readAlternative<Variant, kIndex + 1>(index, reader, names);
        }
    }
    try {
        auto value = read<std::variant_alternative_t<kIndex, Variant>>(reader);
        requireEnd(reader);
        return value;
    } catch (const FormatError& error) {
        throw FormatError(std::string(names[kIndex]) + ": " + error.what());
    }
}

}  // namespace base
