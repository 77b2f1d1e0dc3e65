// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <type_traits>

#include "base/fields.hpp"

/// Forms in which a member of a described type can be written (fields.hpp). Each refers to the member, and lives only
/// while it is visited.
namespace base {

namespace detail {

/// Returns a number in the fewest digits that give it again.
template <class Number>
[[nodiscard]] std::string digitsOf(Number number) {
    if constexpr (std::is_floating_point_v<Number>) {
        std::array<char, 32> text{};
#if defined(__cpp_lib_to_chars)
        return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
#else  // as in the library of emscripten 3
        for (int digits = 1;; ++digits) {
            const int length = std::snprintf(text.data(), text.size(), "%.*g", digits, static_cast<double>(number));
            if (digits == 17 || static_cast<Number>(std::strtod(text.data(), nullptr)) == number) {
                return {text.data(), static_cast<std::size_t>(length)};
            }
        }
#endif
    } else {
        return std::to_string(number);
    }
}

}  // namespace detail

/// Integer of 0 or more, with 7 bits in each byte.
template <class Number>
struct Varint {
    Number& value;
    void put(ByteWriter& writer) const { writer.putVarint(static_cast<std::uint64_t>(value)); }
    void get(ByteReader& reader) const requires(!std::is_const_v<Number>) {
        const std::uint64_t read = reader.getVarint();
        if (read > static_cast<std::uint64_t>(std::numeric_limits<Number>::max())) {
            throw FormatError("is " + std::to_string(read) + ", which is too large");
        }
        value = static_cast<Number>(read);
    }
};
template <class Number>
[[nodiscard]] Varint<Number> varint(Number& value) {
    return {value};
}

/// Number of fixed size from `least` to `most`.
template <class Number>
struct Limited {
    Number& value;
    std::remove_const_t<Number> least, most;
    void put(ByteWriter& writer) const { writer.put(value); }
    void get(ByteReader& reader) const requires(!std::is_const_v<Number>) {
        value = reader.get<Number>();
        if (!(value >= least && value <= most)) {  // refuses NaN too
            throw FormatError("is " + detail::digitsOf(value) + ", not from " + detail::digitsOf(least) + " to " +
                              detail::digitsOf(most));
        }
    }
};
template <class Number>
[[nodiscard]] Limited<Number> limited(Number& value, std::type_identity_t<std::remove_const_t<Number>> least,
                                      std::type_identity_t<std::remove_const_t<Number>> most) {
    return {value, least, most};
}

/// Float of fixed size that need not be finite.
template <class Float>
struct AnyFloat {
    Float& value;
    void put(ByteWriter& writer) const { writer.put(value); }
    void get(ByteReader& reader) const requires(!std::is_const_v<Float>) { value = reader.get<Float>(); }
};
template <class Float>
[[nodiscard]] AnyFloat<Float> anyFloat(Float& value) {
    return {value};
}

/// Number that is always the same, such as the first bytes of a file. `what` names it. It belongs to no member.
template <class Number>
struct Constant {
    Number value;
    std::string_view what;
    void put(ByteWriter& writer) const { writer.put(value); }
    void get(ByteReader& reader) const {
        if (const auto read = reader.get<Number>(); read != value) {
            throw FormatError("is " + std::to_string(read) + ", not " + std::string(what));
        }
    }
};
template <class Number>
[[nodiscard]] Constant<Number> constant(Number value, std::string_view what) {
    return {value, what};
}

/// Bools in one integer, the first in its lowest bit. The other bits are 0.
template <class Number, class Truth, std::size_t kCount>
struct Flags {
    std::array<Truth*, kCount> values;
    void put(ByteWriter& writer) const {
        unsigned bits = 0;
        for (std::size_t i = 0; i < kCount; ++i) {
            bits |= static_cast<unsigned>(*values[i]) << i;
        }
        writer.put(static_cast<Number>(bits));
    }
    void get(ByteReader& reader) const requires(!std::is_const_v<Truth>) {
        const auto bits = static_cast<std::make_unsigned_t<Number>>(reader.get<Number>());
        if (bits >> kCount != 0) {
            throw FormatError("is " + std::to_string(bits) + ", with unknown bits");
        }
        for (std::size_t i = 0; i < kCount; ++i) {
            *values[i] = (bits >> i & 1U) != 0;
        }
    }
};
template <class Number = std::uint8_t, class Truth, class... More>
[[nodiscard]] Flags<Number, Truth, 1 + sizeof...(More)> flags(Truth& first, More&... more) {
    static_assert(sizeof...(more) < 8);
    return {{&first, &more...}};
}

/// Array with one element for each value of `Enum`, in the order of valuesOf(). Each element has the name of its value
/// in JSON.
template <NamedEnum Enum, class Elements>
struct ByName {
    Elements& value;
    void put(ByteWriter& writer) const { putMember(writer, value); }
    void get(ByteReader& reader) const requires(!std::is_const_v<Elements>) { getMember(reader, value); }
};
template <NamedEnum Enum, class Elements>
[[nodiscard]] ByName<Enum, Elements> byName(Elements& value) {
    static_assert(std::tuple_size_v<std::remove_const_t<Elements>> == valuesOf(Enum{}).size());
    return {value};
}

/// Elements behind their number, which is at most `most`. `Count` is the type of the number; void stands for a varint.
template <class List, class Count>
struct UpTo {
    List& value;
    std::size_t most;
    void put(ByteWriter& writer) const {
        if constexpr (std::is_void_v<Count>) {
            writer.putVarint(value.size());
        } else {
            writer.put(static_cast<Count>(value.size()));
        }
        for (const auto& element : value) {
            putMember(writer, element);
        }
    }
    void get(ByteReader& reader) const requires(!std::is_const_v<List>) {
        std::uint64_t count = 0;
        if constexpr (std::is_void_v<Count>) {
            count = reader.getVarint();
        } else {
            count = reader.get<Count>();
        }
        if (count > most) {
            throw FormatError("has " + std::to_string(count) + " elements; at most " + std::to_string(most) +
                              " are allowed");
        }
        value.clear();
        for (; count > 0; --count) {  // takes memory only for bytes that are there
            getMember(reader, value.emplace_back());
        }
    }
};
template <class Count = void, class List>
[[nodiscard]] UpTo<List, Count> upTo(List& value, std::size_t most) {
    return {value, most};
}

/// Elements up to the end. Each takes a byte or more.
template <class List>
struct ToEnd {
    List& value;
    void put(ByteWriter& writer) const {
        for (const auto& element : value) {
            putMember(writer, element);
        }
    }
    void get(ByteReader& reader) const requires(!std::is_const_v<List>) {
        value.clear();
        while (!reader.atEnd()) {
            getMember(reader, value.emplace_back());
        }
    }
};
template <class List>
[[nodiscard]] ToEnd<List> toEnd(List& value) {
    return {value};
}

/// `count` elements without their number, which both sides know.
template <class List>
struct Exactly {
    List& value;
    std::size_t count;
    void put(ByteWriter& writer) const {
        for (std::size_t i = 0; i < count; ++i) {
            putMember(writer, value[i]);
        }
    }
    void get(ByteReader& reader) const requires(!std::is_const_v<List>) {
        value.clear();
        while (value.size() < count) {
            getMember(reader, value.emplace_back());
        }
    }
};
template <class List>
[[nodiscard]] Exactly<List> exactly(List& value, std::size_t count) {
    return {value, count};
}

/// Text of at most `most` bytes behind its length of 32 bits.
template <class Text>
struct TextUpTo {
    Text& value;
    std::size_t most;
    void put(ByteWriter& writer) const { writer.putText(std::string_view(value).substr(0, most)); }
    void get(ByteReader& reader) const requires(!std::is_const_v<Text>) {
        const auto block = reader.getBlock();
        if (block.size() > most) {
            throw FormatError("has " + std::to_string(block.size()) + " bytes; at most " + std::to_string(most) +
                              " are allowed");
        }
        value.assign(block.begin(), block.end());
    }
};
template <class Text>
[[nodiscard]] TextUpTo<Text> text(Text& value, std::size_t most) {
    return {value, most};
}

/// Member behind a byte that is 0 or 1. The member's bytes are there in any case.
template <class Optional>
struct SpacedOptional {
    Optional& value;
    using Member = typename std::remove_const_t<Optional>::value_type;
    void put(ByteWriter& writer) const {
        writer.put(static_cast<std::uint8_t>(value.has_value()));
        putMember(writer, value.value_or(Member{}));
    }
    void get(ByteReader& reader) const requires(!std::is_const_v<Optional>) {
        const bool there = detail::getBool(reader);
        Member member{};
        getMember(reader, member);
        value = there ? Optional(member) : std::nullopt;
    }
};
template <class Optional>
[[nodiscard]] SpacedOptional<Optional> spacedOptional(Optional& value) {
    return {value};
}

/// Text as TextUpTo behind a 1, or a 0 alone.
template <class Optional>
struct OptionalText {
    Optional& value;
    std::size_t most;
    void put(ByteWriter& writer) const {
        writer.put(static_cast<std::uint8_t>(value.has_value()));
        if (value) {
            text(*value, most).put(writer);
        }
    }
    void get(ByteReader& reader) const requires(!std::is_const_v<Optional>) {
        value.reset();
        if (detail::getBool(reader)) {
            text(value.emplace(), most).get(reader);
        }
    }
};
template <class Optional>
[[nodiscard]] OptionalText<Optional> optionalText(Optional& value, std::size_t most) {
    return {value, most};
}

/// Texts behind their number, each as TextUpTo. `most` limits their number, too.
template <class Texts>
struct TextsUpTo {
    Texts& value;
    std::size_t most;
    void put(ByteWriter& writer) const {
        writer.putVarint(value.size());
        for (const auto& one : value) {
            text(one, most).put(writer);
        }
    }
    void get(ByteReader& reader) const requires(!std::is_const_v<Texts>) {
        std::uint64_t count = reader.getVarint();
        if (count > most) {
            throw FormatError("has " + std::to_string(count) + " texts; at most " + std::to_string(most) +
                              " are allowed");
        }
        value.clear();
        for (; count > 0; --count) {
            text(value.emplace_back(), most).get(reader);
        }
    }
};
template <class Texts>
[[nodiscard]] TextsUpTo<Texts> texts(Texts& value, std::size_t most) {
    return {value, most};
}

/// Bytes behind their length of 32 bits.
template <class AnyBytes>
struct Block {
    AnyBytes& value;
    void put(ByteWriter& writer) const { writer.putBlock(value); }
    void get(ByteReader& reader) const requires(!std::is_const_v<AnyBytes>) {
        const auto block = reader.getBlock();
        value.assign(block.begin(), block.end());
    }
};
template <class AnyBytes>
[[nodiscard]] Block<AnyBytes> block(AnyBytes& value) {
    return {value};
}

/// Described value in a block of its own, which is empty for nullopt.
template <class Optional>
struct OptionalBlock {
    Optional& value;
    using Member = typename std::remove_const_t<Optional>::value_type;
    void put(ByteWriter& writer) const { writer.putBlock(value ? encoded(*value) : Bytes()); }
    void get(ByteReader& reader) const requires(!std::is_const_v<Optional>) {
        const auto block = reader.getBlock();
        value = block.empty() ? std::nullopt : Optional(decoded<Member>(block));
    }
};
template <class Optional>
[[nodiscard]] OptionalBlock<Optional> optionalBlock(Optional& value) {
    return {value};
}

/// All bytes up to the end.
template <class AnyBytes>
struct Rest {
    AnyBytes& value;
    void put(ByteWriter& writer) const { writer.putBytes(value); }
    void get(ByteReader& reader) const requires(!std::is_const_v<AnyBytes>) {
        const auto bytes = reader.getBytes(reader.rest().size());
        value.assign(bytes.begin(), bytes.end());
    }
};
template <class AnyBytes>
[[nodiscard]] Rest<AnyBytes> rest(AnyBytes& value) {
    return {value};
}

/// Bytes without a meaning up to the end. The member is their number; they are written as 0.
template <class Number>
struct Padding {
    Number& count;
    void put(ByteWriter& writer) const { writer.putBytes(Bytes(count, 0)); }
    void get(ByteReader& reader) const requires(!std::is_const_v<Number>) {
        count = static_cast<Number>(reader.rest().size());
        reader.getBytes(count);
    }
};
template <class Number>
[[nodiscard]] Padding<Number> padding(Number& count) {
    return {count};
}

}  // namespace base
