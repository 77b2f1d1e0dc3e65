// SPDX-License-Identifier: Apache-2.0
#include "base/text_decoder.hpp"

#include <array>
#include <cstdint>

#include "base/input_error.hpp"

namespace base {
namespace {

constexpr char32_t kMark = 0xFEFF;         // byte order mark; inside a text it is an invisible blank
constexpr char32_t kReplacement = 0xFFFD;  // for half of a surrogate pair
constexpr char32_t kNoBreakSpace = 0xA0;

std::uint8_t byteAt(std::string_view bytes, std::size_t at) { return static_cast<std::uint8_t>(bytes[at]); }

/// Returns the length of a character of UTF-8 by its first byte, or 0 for a byte that begins none.
std::size_t lengthOf(std::uint8_t first) {
    if (first >= 0xC2 && first < 0xE0) {
        return 2;
    }
    if (first >= 0xE0 && first < 0xF0) {
        return 3;
    }
    return first >= 0xF0 && first < 0xF5 ? 4 : 0;
}

/// Returns how many of the bytes at `at` can be the begin of one character of UTF-8, at most its length.
std::size_t validPart(std::string_view bytes, std::size_t at, std::size_t length) {
    std::size_t count = 1;
    while (count < length && at + count < bytes.size() && (byteAt(bytes, at + count) & 0xC0U) == 0x80U) {
        ++count;
    }
    return count;
}

char32_t characterAt(std::string_view bytes, std::size_t at, std::size_t length) {
    char32_t character = byteAt(bytes, at) & (0xFFU >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        character = character << 6U | (byteAt(bytes, at + i) & 0x3FU);
    }
    return character;
}

/// Returns whether `length` bytes are the shortest form of a character.
bool isCharacter(char32_t character, std::size_t length) {
    const bool shortest = character >= (length == 2 ? 0x80U : length == 3 ? 0x800U : 0x10000U);
    return shortest && character <= 0x10FFFF && (character < 0xD800 || character > 0xDFFF);
}

void appendUtf8(char32_t character, std::string& text) {
    const auto follow = [&](unsigned shift) {
        text.push_back(static_cast<char>(0x80U | ((character >> shift) & 0x3FU)));
    };
    if (character < 0x80) {
        text.push_back(static_cast<char>(character));
    } else if (character < 0x800) {
        text.push_back(static_cast<char>(0xC0U | character >> 6U));
        follow(0);
    } else if (character < 0x10000) {
        text.push_back(static_cast<char>(0xE0U | character >> 12U));
        follow(6);
        follow(0);
    } else {
        text.push_back(static_cast<char>(0xF0U | character >> 18U));
        follow(12);
        follow(6);
        follow(0);
    }
}

}  // namespace

void TextDecoder::fail(const std::string& message) const { throw InputError(file_, line_, message); }

void TextDecoder::add(std::string_view bytes, std::string& text) {
    waiting_.append(bytes);
    choose(false);
    if (encoding_ != Encoding::unknown) {
        waiting_.erase(0, encoding_ == Encoding::bytes ? takeBytes(false, text) : takeUtf16(text));
    }
}

void TextDecoder::finish(std::string& text) {
    choose(true);
    waiting_.erase(0, encoding_ == Encoding::bytes ? takeBytes(true, text) : takeUtf16(text));
    if (!waiting_.empty()) {
        fail("the text ends in the middle of a character of UTF-16; the file may be cut");
    }
}

void TextDecoder::choose(bool atEnd) {
    constexpr std::size_t kEnough = 4;
    if (encoding_ != Encoding::unknown || (waiting_.size() < kEnough && !atEnd)) {
        return;
    }
    const std::string_view begin = std::string_view(waiting_).substr(0, kEnough);
    using namespace std::string_view_literals;
    if (begin == "\xFF\xFE\0\0"sv || begin == "\0\0\xFE\xFF"sv) {
        fail("begins with the byte order mark of UTF-32; save it as UTF-8");
    }
    // Without a mark, every second byte of an ASCII text in UTF-16 is 0.
    const auto zeros = [&](std::size_t first) {
        return begin.size() == kEnough && begin[first] == 0 && begin[first + 2] == 0 && begin[1 - first] != 0 &&
               begin[3 - first] != 0;
    };
    if (begin.starts_with("\xFF\xFE") || zeros(1)) {
        encoding_ = Encoding::utf16Little;
    } else if (begin.starts_with("\xFE\xFF") || zeros(0)) {
        encoding_ = Encoding::utf16Big;
    } else {
        encoding_ = Encoding::bytes;
    }
}

std::size_t TextDecoder::takeBytes(bool atEnd, std::string& text) {
    const std::string_view bytes = waiting_;
    std::size_t at = 0;
    while (at < bytes.size()) {
        const std::uint8_t first = byteAt(bytes, at);
        if (first < 0x80) {
            putPlain(bytes[at++], text);
            continue;
        }
        const std::size_t length = lengthOf(first);
        const std::size_t valid = length == 0 ? 0 : validPart(bytes, at, length);
        if (valid < length && at + valid == bytes.size() && !atEnd) {
            break;  // the rest of the character may follow
        }
        const bool whole = length > 0 && valid == length && isCharacter(characterAt(bytes, at, length), length);
        put(whole ? characterAt(bytes, at, length) : char32_t{first}, text);  // Latin-1 has Unicode's numbers
        at += whole ? length : 1;
    }
    return at;
}

std::size_t TextDecoder::takeUtf16(std::string& text) {
    const std::string_view bytes = waiting_;
    const bool little = encoding_ == Encoding::utf16Little;
    const auto unitAt = [&](std::size_t at) {
        return static_cast<char32_t>(byteAt(bytes, at + (little ? 1 : 0)) << 8U | byteAt(bytes, at + (little ? 0 : 1)));
    };
    std::size_t at = 0;
    while (at + 2 <= bytes.size()) {
        const char32_t unit = unitAt(at);
        if (unit < 0xD800 || unit > 0xDFFF) {
            put(unit, text);
            at += 2;
            continue;
        }
        if (at + 4 > bytes.size()) {
            break;
        }
        const char32_t second = unitAt(at + 2);
        const bool pair = unit < 0xDC00 && second >= 0xDC00 && second <= 0xDFFF;
        put(pair ? 0x10000 + ((unit - 0xD800) << 10U) + (second - 0xDC00) : kReplacement, text);
        at += pair ? 4 : 2;
    }
    return at;
}

void TextDecoder::put(char32_t character, std::string& text) {
    if (character < 0x80) {
        putPlain(static_cast<char>(character), text);
    } else if (character == kNoBreakSpace) {
        putPlain(' ', text);
    } else if (character != kMark) {
        if (end_ >= 0) {
            putPlain('?', text);  // refuses it
        }
        afterReturn_ = false;
        appendUtf8(character, text);
    }
}

void TextDecoder::putPlain(char character, std::string& text) {
    constexpr char kDosEnd = 0x1A;
    if (character == kDosEnd || character == 0) {
        end_ = end_ < 0 ? character : end_;
        return;
    }
    const bool blank = character == ' ' || character == '\t' || character == '\r' || character == '\n' ||
                       character == '\f' || character == '\v';
    if (end_ >= 0 && !blank) {
        fail(end_ == 0 ? "a byte 0 is inside the text; the file is damaged, or no text; save it as UTF-8"
                       : "a byte 0x1A, with which texts of DOS end, is inside the text; remove it");
    }
    if (character == '\n' && afterReturn_) {
        afterReturn_ = false;
        return;  // the carriage return before it has ended the line
    }
    afterReturn_ = character == '\r';
    if (character == '\r' || character == '\n') {
        ++line_;
        text.push_back('\n');
    } else {
        text.push_back(character == '\f' || character == '\v' ? ' ' : character);
    }
}

}  // namespace base
